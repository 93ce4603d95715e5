import { Button } from "@mantine/core";
import { useRouteError } from "react-router";
import { Failure } from "../parts/Failure";

/** A page that threw: say so, and offer a way on. */
export function BrokenPage() {
  const error = useRouteError();
  return (
    <Failure
      what="This page failed"
      error={error}
      safe="Nothing that was saved is affected, and annotations that were still waiting are kept in this browser."
      onRetry={() => window.location.reload()}
    >
      <Button variant="default" component="a" href="/recordings">
        To the recordings
      </Button>
    </Failure>
  );
}
