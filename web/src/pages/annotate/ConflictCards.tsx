import { keyText, parseKey } from "../../model/pose";
import { activeKey } from "../../state/annotator";
import { settleConflict } from "../../state/session";
import { useAnnotating } from "./annotating";
import { useAnnotation, useSaving } from "./reading";
import { ConflictCard } from "./ConflictCard";

/** One card for each hand that somebody else has changed at the same time. */
export function ConflictCards() {
  const { session } = useAnnotating();
  const conflicts = useSaving((saving) => saving.conflicts);
  const here = useAnnotation((state) => keyText(activeKey(state)));
  const poses = useAnnotation((state) => state.poses);
  return [...conflicts].map(([key, version]) => (
    <ConflictCard
      key={key}
      poseKey={key}
      mine={poses[key]}
      theirs={version}
      isHere={key === here}
      onGo={() => session.store.set({ ...session.store.get(), ...parseKey(key), isChosen: false, draft: null }, "person")}
      onSettle={(choice) => settleConflict(session, key, choice)}
    />
  ));
}
