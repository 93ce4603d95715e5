import { Badge, Button, Group, Stack, Text, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconCornerDownRight, IconHandStop, IconMan, IconRefresh } from "@tabler/icons-react";
import { Link } from "react-router";
import { useHandModels, type HandModel } from "../../api/handModels";
import { formatAgo, formatCount } from "../../model/format";
import { CardTable, type Column } from "../parts/CardTable";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { HandBadge } from "../parts/HandBadge";
import { LoadingRows } from "../parts/LoadingRows";
import { useTitle } from "../parts/useTitle";
import { Detectors } from "./Detectors";
import { LoopDialog } from "./LoopDialog";
import classes from "./Models.module.css";
import { TrainDialog } from "./TrainDialog";
import { TrainingSets } from "./TrainingSets";

const KINDS: Record<HandModel["kind"], string> = { default: "built in, tracks", untrained: "not trained yet", trained: "trained here", uploaded: "uploaded" };

/** Each model followed by those trained from it, the newest branch first. */
export function asTree(models: readonly HandModel[]): { model: HandModel; depth: number }[] {
  const known = new Set(models.map((model) => model.id));
  const below = (parent: string | null, depth: number): { model: HandModel; depth: number }[] =>
    models
      .filter((model) => (parent === null ? !model.parent_id || !known.has(model.parent_id) : model.parent_id === parent))
      .flatMap((model) => [{ model, depth }, ...below(model.id, depth + 1)]);
  return below(null, 0);
}

export function ModelKind({ model }: { model: HandModel }) {
  return (
    <Badge variant="light" color={model.kind === "trained" ? "teal" : "gray"} tt="none">
      {model.kind === "trained" ? `round ${model.round}` : KINDS[model.kind]}
    </Badge>
  );
}

const COLUMNS: readonly Column<HandModel & { depth: number }>[] = [
  {
    head: "Name",
    full: ({ name }) => name,
    show: ({ id, name, depth }) => (
      <span style={{ paddingLeft: 20 * Math.max(0, depth - 1) }}>
        {depth > 0 && <IconCornerDownRight size={14} aria-label="trained from the one above" style={{ marginRight: 6, verticalAlign: -2 }} />}
        <Link to={`/models/${id}`} className={classes.link}>
          {name}
        </Link>
      </span>
    ),
  },
  { head: "Kind", width: 152, show: (model) => <ModelKind model={model} /> },
  { head: "Hand", width: 80, show: ({ side }) => <HandBadge hand={side} /> },
  { head: "Vertices", width: 96, isNumber: true, show: ({ vertices }) => vertices.toLocaleString("en") },
  { head: "Shape", width: 80, isNumber: true, show: ({ shape_parameters: shape }) => shape.length },
  { head: "Pose", width: 80, isNumber: true, show: ({ pose_components: count }) => count },
  { head: "Registrations", width: 128, isNumber: true, show: ({ registration_count: count }) => count > 0 && count.toLocaleString("en") },
  { head: "Made", width: 128, isNumber: true, isQuiet: true, show: ({ created_at: when }) => when && formatAgo(when) },
];

/** Hand models as a lineage: which was trained from which, by how many registrations. */
export default function ModelsPage() {
  useTitle("Hand models");
  const { data: models, error, refetch } = useHandModels();
  const [isTraining, training] = useDisclosure(false);
  const [isLooping, looping] = useDisclosure(false);
  if (error && !models) return <Failure what="The hand models could not be loaded" error={error} safe="They are untouched on the server's disk." onRetry={() => void refetch()} />;
  const hasTrained = models?.some((model) => model.kind === "trained");
  return (
    <div className="page">
      <Group mb="lg" justify="space-between" wrap="nowrap">
        <Group align="baseline" gap="md">
          <Title order={1}>Hand models</Title>
          {models && <span className="quiet">{formatCount(models.length, "model")}</span>}
        </Group>
        <Group gap="sm" wrap="nowrap">
          <Button variant="default" component={Link} to="/models/body" leftSection={<IconMan size={16} aria-hidden />}>
            Body with hands
          </Button>
          <For role="reviewer">
            <Button variant="default" leftSection={<IconRefresh size={16} aria-hidden />} onClick={looping.open}>
              Register, train, again …
            </Button>
            <Button onClick={training.open}>Train …</Button>
          </For>
        </Group>
      </Group>
      <Stack gap="xl">
        {!models && <LoadingRows count={4} height={44} />}
        {models && <CardTable items={asTree(models).map(({ model, depth }) => ({ ...model, depth }))} columns={COLUMNS} />}
        {models && (
          <Text size="xs" className="quiet" mt={-16}>
            Shape and pose: how many components each space has.
          </Text>
        )}
        {models && !hasTrained && (
          <EmptyState
            icon={<IconHandStop size={48} stroke={1.25} />}
            title="No model has been trained here yet"
            action={
              <Button component={Link} to="/scans">
                To the scans
              </Button>
            }
          >
            Register scans with the first model, accept what is right, then train: the new model fits hands better, also when they are registered again with it.
          </EmptyState>
        )}
        <TrainingSets />
        <Detectors />
      </Stack>
      <TrainDialog isOpen={isTraining} onClose={training.close} />
      <LoopDialog isOpen={isLooping} onClose={looping.close} />
    </div>
  );
}
