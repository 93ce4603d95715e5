import { Button, Kbd, Text } from "@mantine/core";
import { useParams } from "react-router";
import { Link } from "react-router";
import { useMovingScan } from "../../api/movingScans";
import { Failure } from "../parts/Failure";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { useKeyOf } from "../../state/keys";
import frame from "../hand3d/HandPage.module.css";
import { MovingReview } from "./MovingReview";

const HINTS = [
  ["moving.play", "play"],
  ["moving.next", "next frame"],
  ["moving.nextDoubt", "next doubt"],
  ["moving.begin", "stretch begins"],
  ["moving.end", "stretch ends"],
  ["moving.accept", "accept"],
  ["moving.reject", "reject"],
  ["moving.undo", "undo"],
  ["moving.errors", "errors"],
  ["moving.layers", "scan or body"],
] as const;

/** A moving scan: played, registered, curated by stretch. `?registration=` and `?frame=` hold what is shown. */
export default function MovingScanPage() {
  const { movingScanId = "" } = useParams();
  const { data: scan, error, refetch } = useMovingScan(movingScanId);
  const keyOf = useKeyOf();
  useTitle(scan?.name ?? "Moving scan");
  if (error && !scan)
    return (
      <Failure what="The moving scan could not be loaded" error={error} onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/scans/moving">
          To the moving scans
        </Button>
      </Failure>
    );
  if (!scan) return <PageSkeleton />;
  return (
    <div className={frame.page}>
      <h1 className="visually-hidden">{scan.name}</h1>
      <MovingReview key={scan.id} scan={scan} />
      <div className={frame.line}>
        {HINTS.map(([id, label]) => (
          <span key={id} className={frame.hint}>
            <Kbd size="xs">{keyOf(id) || "–"}</Kbd>
            <Text size="xs" span>
              {label}
            </Text>
          </span>
        ))}
      </div>
    </div>
  );
}
