import { depthAt, type DepthImage } from "../../canvas/depth";
import { activePose } from "../../state/annotator";
import { scopeOf } from "../../state/saving";
import { useSelect } from "../../state/useStore";
import { SaveState } from "../parts/SaveState";
import { useHasFingers, useIsCompact } from "../parts/useScreen";
import { useAnnotating } from "./annotating";
import { describeClick, describeWait } from "./nextClick";
import { PeopleHere } from "./PeopleHere";
import { useAnnotation, useOption, usePage, usePicturesHere, useSaving } from "./reading";
import classes from "./StatusLine.module.css";

/** What is under the pointer in the active camera's picture. */
function Here({ depth }: { depth: DepthImage | null }) {
  const camera = useAnnotation((state) => state.camera);
  const pixel = useSelect(useAnnotating().hover, (hover) => (hover?.camera === camera ? hover.pixel : null));
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

function NextClick() {
  const lock = usePage((page) => page.lock);
  const isPlaying = usePage((page) => page.isPlaying);
  const isRefused = usePage((page) => page.isRefused);
  const frame = useAnnotation((state) => state.frame);
  const pictures = usePicturesHere((now) => now);
  const placeMode = useOption("placeMode");
  const chosen = useSelect(useAnnotating().over, (over) => over?.joint ?? null);
  const click = useAnnotation((state) => describeClick(state, activePose(state), placeMode, chosen));
  const [isCompact, hasFingers, isMarking] = [useIsCompact(), useHasFingers(), useOption("isTouchMarking")];
  const isLooking = isCompact && hasFingers && !isMarking;
  return (
    <span className={classes.next} data-testid="next-click">
      {lock ?? describeWait(frame, pictures, isPlaying, isRefused) ?? (isLooking ? "Swipe for frames, tap to choose a joint" : `Next click ${click}`)}
    </span>
  );
}

function Saved() {
  const { recording, replica, session } = useAnnotating();
  const saving = useSaving((now) => now);
  return (
    <SaveState
      status={{ ...saving, conflicts: saving.conflicts.size, refusals: saving.refusals.size }}
      own={{ scope: scopeOf(recording.get().id, replica) }}
      what="Every gesture is saved by itself"
      action="save.now"
      onFlush={() => session.flush()}
    />
  );
}

export function StatusLine() {
  const depth = usePicturesHere((now) => now?.depthImage ?? null);
  return (
    <div className={classes.line}>
      <Saved />
      <NextClick />
      <span className={classes.here}>
        <PeopleHere />
        <Here depth={depth} />
      </span>
    </div>
  );
}
