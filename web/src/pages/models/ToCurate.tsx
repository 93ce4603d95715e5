import { Button } from "@mantine/core";
import { Link } from "react-router";

/** The next step when too little is accepted to learn from. */
export function ToCurate({ collection }: { collection: string }) {
  return (
    <Button component={Link} to={collection ? `/curate?collection=${encodeURIComponent(collection)}` : "/curate"} variant="default" size="xs" style={{ alignSelf: "flex-start" }}>
      Accept registrations
    </Button>
  );
}
