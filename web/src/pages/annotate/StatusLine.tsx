import type { DepthImage } from "../../canvas/depth";
import { depthAt } from "../../canvas/depth";
import { useOver, usePointer, type PointerStore } from "../../state/pointer";
import { useSearchParams } from "react-router";
import { scopeOf } from "../../state/saving";
import { SaveState } from "../parts/SaveState";
import { useHasFingers, useIsCompact } from "../parts/useScreen";
import { useAnnotating } from "./annotating";
import { describeClick, describeWait } from "./nextClick";
import { PeopleHere } from "./PeopleHere";
import classes from "./StatusLine.module.css";

function Here({ pointer, depth }: { pointer: PointerStore; depth: DepthImage | null }) {
  const pixel = usePointer(pointer);
  if (!pixel) return null;
  const distance = depth && depthAt(depth, pixel.x, pixel.y);
  return (
    <>
      <span className={classes.figure} style={{ minWidth: 116 }}>
        {pixel.x.toFixed(1)}, {pixel.y.toFixed(1)} px
      </span>
      {depth && (
        <span className={classes.figure} style={{ minWidth: 72 }}>
          {distance === null ? "no depth" : `${distance.toFixed(4)} m`}
        </span>
      )}
    </>
  );
}

export function StatusLine() {
  const [address] = useSearchParams();
  const { recording, state, pose, saving, pointer, pictures, lock, session, options, isPlaying, isRefused, over } = useAnnotating();
  const chosen = useOver(over);
  const [isCompact, hasFingers] = [useIsCompact(), useHasFingers()];
  const isLooking = isCompact && hasFingers && !options.isTouchMarking;
  return (
    <div className={classes.line}>
      <SaveState status={{ ...saving, conflicts: saving.conflicts.size, refusals: saving.refusals.size }} own={{ scope: scopeOf(recording.id, address.get("replica")) }} what="Every gesture is saved by itself" action="save.now" onFlush={() => session.flush()} />
      <span className={classes.next} data-testid="next-click">
        {lock ?? describeWait(state, pictures, isPlaying, isRefused) ?? (isLooking ? "Swipe for frames, tap to choose a joint" : `Next click ${describeClick(state, pose, options.placeMode, chosen?.joint ?? null)}`)}
      </span>
      <span className={classes.here}>
        <PeopleHere />
        <Here pointer={pointer} depth={pictures.depthImage} />
      </span>
    </div>
  );
}
