import { keyText, parseKey } from "../../model/pose";
import { activeKey } from "../../state/annotator";
import { settleConflict } from "../../state/session";
import { useAnnotating } from "./annotating";
import { ConflictCard } from "./ConflictCard";

/** One card for each hand that somebody else has changed at the same time. */
export function ConflictCards() {
  const { state, saving, session } = useAnnotating();
  const here = keyText(activeKey(state));
  return [...saving.conflicts].map(([key, version]) => (
    <ConflictCard
      key={key}
      poseKey={key}
      mine={state.poses[key]}
      theirs={version}
      isHere={key === here}
      onGo={() => session.store.set({ ...session.store.get(), ...parseKey(key), isChosen: false, draft: null }, "person")}
      onSettle={(choice) => settleConflict(session, key, choice)}
    />
  ));
}
