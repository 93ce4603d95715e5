import { Button } from "@mantine/core";
import { IconMapOff } from "@tabler/icons-react";
import { Link } from "react-router";
import { EmptyState } from "../parts/EmptyState";
import { useTitle } from "../parts/useTitle";

export function MissingPage() {
  useTitle("Nothing here");
  return (
    <EmptyState
      icon={<IconMapOff size={48} stroke={1.25} />}
      title="There is no page at this address"
      action={
        <Button component={Link} to="/recordings">
          To the recordings
        </Button>
      }
    >
      The link may be cut off, or what it shows was deleted.
    </EmptyState>
  );
}
