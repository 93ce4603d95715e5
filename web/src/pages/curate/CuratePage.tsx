import { Button, Group, Kbd, Text } from "@mantine/core";
import { IconChecks, IconScan } from "@tabler/icons-react";
import { useQueryClient } from "@tanstack/react-query";
import { useEffect, useRef } from "react";
import { Link } from "react-router";
import { useKeymap } from "../../actions/useKeymap";
import { registrationKeys, useQueueCounts, useReasons } from "../../api/registrations";
import { formatCount } from "../../model/format";
import { decisionOf, shownIn } from "../../state/curation";
import { decisionLog } from "../../state/deciding";
import type { Standing } from "../../state/decisionLog";
import { useKeyOf } from "../../state/keys";
import { hasRole, useMe } from "../../state/me";
import { HandRail } from "../hand3d/HandRail";
import { HandView } from "../hand3d/HandView";
import { handHandlers, useLook } from "../hand3d/useLook";
import { useStage } from "../../canvas/hand3d/useStage";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { SaveState } from "../parts/SaveState";
import { useTitle } from "../parts/useTitle";
import frame from "../hand3d/HandPage.module.css";
import classes from "./CuratePage.module.css";
import { DecisionPanel } from "./DecisionPanel";
import { DecisionRefusals } from "./DecisionRefusals";
import { QueueBar } from "./QueueBar";
import { useCuration, useDecisionStatus } from "./useCuration";
import { useQueueAddress } from "./useQueueAddress";
import { useShownHand } from "./useShownHand";

const HINTS = [
  ["curate.accept", "accept"],
  ["curate.reject", "reject"],
  ["curate.unsure", "unsure"],
  ["curate.reason1", "… with a reason"],
  ["curate.undo", "take back"],
  ["curate.next", "next"],
  ["curate.errors", "errors"],
  ["curate.layers", "scan or mesh"],
  ["curate.turntable", "turn"],
] as const;

/** One registration after the other, huge: accept, reject or unsure by single keys. `?queue=`, `?order=`, `?collection=` hold which. */
export default function CuratePage() {
  useTitle("Curate");
  const [choice, setChoice, first] = useQueueAddress();
  const { curation, state, isLoading, failure, retry } = useCuration(choice, first);
  const item = shownIn(state);
  const counts = useQueueCounts(choice).data;
  const reasons = useReasons().data ?? [];
  const status = useDecisionStatus();
  const keyOf = useKeyOf();
  const client = useQueryClient();

  const drawn = useRef("");
  const parts = useStage(drawn);
  const { stage } = parts;
  const control = useLook(stage);
  const hand = useShownHand(stage, curation, drawn);

  // Other pages show what was decided here.
  useEffect(() => () => void client.invalidateQueries({ queryKey: registrationKeys.all }), [client]);

  const mayDecide = hasRole(useMe(), "reviewer");
  const decide = (decision: Standing, why: readonly string[] = []): void => {
    // As it is now, not as of the last rendering: nothing is judged that is not on the screen, and no key is lost.
    const isSeen = drawn.current !== "" && drawn.current === shownIn(curation.store.get())?.id;
    if (isSeen && mayDecide) curation.decide(decision, why);
  };
  /** A key that is held judges once: what comes next has not been looked at. */
  const decideByKey = (decision: Standing, why: readonly string[] = []) => (event: KeyboardEvent): void => {
    if (!event.repeat) decide(decision, why);
  };
  // After a click the keys belong to the picture again.
  const decideByClick = (decision: Standing, why: readonly string[] = []): void => {
    decide(decision, why);
    parts.element.current?.focus({ preventScroll: true });
  };
  const undoByClick = (): void => {
    curation.undo();
    parts.element.current?.focus({ preventScroll: true });
  };
  useKeymap("curate", {
    ...handHandlers("curate", stage, control),
    undo: curation.undo,
    "curate.accept": decideByKey("accept"),
    "curate.reject": decideByKey("reject"),
    "curate.unsure": decideByKey("unsure"),
    "curate.undo": curation.undo,
    "curate.next": () => curation.go(1),
    "curate.previous": () => curation.go(-1),
    "curate.save": () => decisionLog().flush(),
    ...Object.fromEntries(reasons.map((reason, at) => [`curate.reason${at + 1}`, decideByKey("reject", [reason.name])])),
  });

  const mine = item ? decisionOf(state, item) : null;
  const isEnd = !isLoading && !item && !state.hasMore;
  const isEmptyStudio = isEnd && state.items.length === 0 && counts?.all === 0;
  return (
    <div className={frame.page}>
      <h1 className="visually-hidden">Curate</h1>
      <QueueBar choice={choice} onChange={setChoice} state={state} />
      <div className={frame.middle}>
        {!isEnd && <HandRail scope="curate" control={control} hasMesh />}
        <HandView
          scope="curate"
          label={item ? `Scan and registered mesh of ${item.scan.name}` : "Scan and registered mesh"}
          parts={parts}
          isBusy={!hand.isDrawn && !isEnd}
          hasLegend={control.look.hasErrors && hand.isDrawn}
          failure={
            failure && !item ? (
              <Failure what="The queue could not be loaded" error={failure} safe="Decisions made so far are kept." onRetry={retry} />
            ) : hand.failure && item ? (
              <Failure what={`${item.scan.name} could not be drawn`} error={hand.failure} safe="Go on with the next one; this one stays in the queue." onRetry={hand.retry}>
                <Button onClick={() => curation.go(1)}>Next</Button>
              </Failure>
            ) : isEmptyStudio ? (
              <EmptyState icon={<IconScan size={56} stroke={1.25} />} title="Nothing to curate yet" action={<Button component={Link} to="/scans">To the scans</Button>}>
                Upload scans of hands and register them: each registration comes here to be accepted or rejected, the likely failures first.
              </EmptyState>
            ) : isEnd ? (
              <EmptyState
                icon={<IconChecks size={56} stroke={1.25} />}
                title={state.items.length > 0 ? "The queue is done" : "Nothing in this queue"}
                action={
                  <Group gap="sm">
                    {state.items.length > 0 && (
                      <Button variant="default" onClick={() => curation.go(-1)}>
                        Back to the last one
                      </Button>
                    )}
                    <Button component={Link} to="/models">
                      Train a model
                    </Button>
                  </Group>
                }
              >
                {state.times.length > 0
                  ? `${formatCount(state.times.length, "decision")} in this visit. What is accepted can train a hand model.`
                  : "Choose another queue above, or train a model from what is accepted."}
              </EmptyState>
            ) : undefined
          }
        >
          {item && <div className={classes.place}>{`${state.place + 1}${state.hasMore ? "" : ` of ${state.items.length}`} · ${item.scan.name}`}</div>}
          <DecisionRefusals status={status} onGo={curation.goTo} />
        </HandView>
        {item ? (
          <DecisionPanel item={item} mine={mine} reasons={reasons} mayDecide={mayDecide} isDrawn={hand.isDrawn} onDecide={decideByClick} canUndo={state.steps.length > 0} onUndo={undoByClick} />
        ) : (
          !isEnd && <aside className={classes.panel} aria-label="The registration and the decision" />
        )}
      </div>
      <div className={frame.line}>
        <SaveState status={{ ...status, refusals: status.refusals.size }} own="decisions" what="Every decision is kept in this browser until the server has it" action="curate.save" onFlush={() => decisionLog().flush()} />
        {HINTS.filter(([id]) => !isEnd || id === "curate.undo").map(([id, label]) => (
          <span key={id} className={frame.hint}>
            <Kbd size="xs">{id === "curate.reason1" && keyOf(id) === "1" ? "1–9" : keyOf(id) || "–"}</Kbd>
            <Text size="xs" span>
              {label}
            </Text>
          </span>
        ))}
      </div>
    </div>
  );
}
