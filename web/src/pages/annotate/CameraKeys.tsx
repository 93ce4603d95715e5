import { notifications } from "@mantine/notifications";
import { useRef } from "react";
import { acceptAll } from "../../actions/annotate/accept";
import { activateCamera } from "../../actions/annotate/cameras";
import { jointLabel } from "../../model/joints";
import { lookAt } from "../../model/look";
import { keyText } from "../../model/pose";
import { suggestViews, worstMarks } from "../../model/triangulated";
import { suggest } from "../../state/suggestions";
import { useActions, useAnnotating } from "./annotating";
import { shownCamerasOf, useShownCameras } from "./reading";
import { useTriangulation } from "./useTriangulation";

/** The keys for several cameras of one moment: what their marks say together, and what is looked at. */
export function CameraKeys() {
  const annotating = useAnnotating();
  const { recording, session, page, sizes, act, setView, show } = annotating;
  const { joints, fetchNow } = useTriangulation();
  const isAlone = useShownCameras().length === 1;
  const looked = useRef({ place: "", turn: 0 });
  const visited = useRef({ marks: "", next: 0 });

  const triangulate = async (): Promise<void> => {
    const state = session.store.get();
    if (recording.get().cameras.length < 2) return void notifications.show({ message: "This recording has one camera: there is nothing to triangulate." });
    try {
      const answer = await fetchNow();
      if (!answer) {
        notifications.show({ message: `No joint of the ${state.hand} hand is marked in two cameras yet. Mark the ${jointLabel(state.joint)} in another camera, then press T again.` });
        return;
      }
      const suggestions = suggestViews(answer.found, answer.views, state, state.poses);
      suggest(session.suggestions, suggestions);
      const refusals = answer.found.joints.flatMap(({ refusal }, joint) => (refusal && !refusal.startsWith("Marked in") ? [`${jointLabel(joint)}: ${refusal}`] : []));
      if (refusals.length > 0) notifications.show({ color: "yellow", message: refusals[0] + (refusals.length > 1 ? ` (and ${refusals.length - 1} more)` : "") });
      else if (suggestions.length === 0) notifications.show({ message: "Every camera that sees these joints has them marked already." });
    } catch (failure) {
      notifications.show({ color: "red", message: `Not triangulated: ${failure instanceof Error ? failure.message : String(failure)} The marks are safe; press T to try again.` });
    }
  };

  const look = (): void => {
    const state = session.store.get();
    const place = `${state.frame}|${state.hand}|${state.joint}`;
    const turn = looked.current.place === place ? (looked.current.turn + 1) % 3 : 0;
    looked.current = { place, turn };
    for (const camera of shownCamerasOf(annotating)) {
      const size = sizes.get(camera.id);
      const pose = state.poses[keyText({ camera: camera.id, frame: state.frame, hand: state.hand })];
      if (size) setView(camera.id, turn === 2 ? null : lookAt(camera, size, pose, joints, turn === 0 ? state.joint : null));
    }
  };

  const goToWorst = (): void => {
    const { frame, hand } = session.store.get();
    const worst = worstMarks(joints ?? []);
    if (worst.length === 0) return void notifications.show({ message: "No mark can be compared yet: mark a joint in two cameras." });
    const marks = JSON.stringify([frame, hand, worst]);
    const at = visited.current.marks === marks ? visited.current.next % worst.length : 0;
    visited.current = { marks, next: at + 1 };
    const mark = worst[at];
    if (mark) act((now) => ({ ...now, camera: mark.camera, joint: mark.joint, isChosen: true, draft: null }), undefined);
  };

  /** Among the pictures that are shown, with the joint kept; where one alone is shown, the annotator's own keys go through all cameras. */
  const step = (by: 1 | -1) => () => {
    const shown = shownCamerasOf(annotating);
    const at = shown.findIndex(({ id }) => id === session.store.get().camera);
    const next = shown[(at + by + shown.length) % shown.length];
    if (next) act(activateCamera, next.id);
  };

  const enlarge = (): void => {
    const { camera } = session.store.get();
    show({ largeCamera: page.get().largeCamera === camera ? null : camera });
  };

  useActions({
    ...(isAlone ? {} : { "camera.next": step(1), "camera.previous": step(-1) }),
    "views.triangulate": () => void triangulate(),
    "suggestion.frame": () => act(acceptAll, { suggestions: session.suggestions.get(), cameras: shownCamerasOf(annotating).map(({ id }) => id) }),
    "views.look": look,
    "views.large": enlarge,
    "views.worst": goToWorst,
  });
  return null;
}
