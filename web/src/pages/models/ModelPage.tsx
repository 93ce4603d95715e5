import { Button, Group, Menu, Stack, Text, Title } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import { IconChevronDown, IconRefresh, IconTrash } from "@tabler/icons-react";
import { useMemo } from "react";
import { Link, useNavigate, useParams } from "react-router";
import { useRestore } from "../../api/bin";
import { useHandModel, useHandModels, useHideModel, useModelReport } from "../../api/handModels";
import { formatAgo, formatName, formatNumber } from "../../model/format";
import { readReport } from "../../model/trainingReport";
import { Fact } from "../parts/Fact";
import { Failure } from "../parts/Failure";
import { For } from "../parts/For";
import { HandBadge } from "../parts/HandBadge";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { intoBin } from "../parts/undo";
import { RegisterDialog } from "../scans/RegisterDialog";
import { LineageList } from "./LineageList";
import { LiveModel } from "./LiveModel";
import { LoopDialog } from "./LoopDialog";
import { ModelDownloads } from "./ModelDownloads";
import classes from "./Models.module.css";
import { ModelKind } from "./ModelsPage";
import { ReportPlots } from "./ReportPlots";
import { TrainDialog } from "./TrainDialog";

/** One hand model: what it is, how good, where it comes from, and what to do with it next. */
export default function ModelPage() {
  const { modelId = "" } = useParams();
  const { data: model, error, refetch } = useHandModel(modelId);
  const models = useHandModels().data ?? [];
  const parent = models.find((one) => one.id === model?.parent_id);
  const raw = useModelReport(model);
  const report = useMemo(() => raw.data && readReport(raw.data), [raw.data]);
  const hide = useHideModel();
  const restore = useRestore();
  const navigate = useNavigate();
  const [isRegistering, registering] = useDisclosure(false);
  const [isTraining, training] = useDisclosure(false);
  const [isLooping, looping] = useDisclosure(false);
  useTitle(model?.name);
  if (error && !model) {
    return (
      <Failure what="This hand model could not be loaded" error={error} onRetry={() => void refetch()}>
        <Button variant="default" component={Link} to="/models">
          To the hand models
        </Button>
      </Failure>
    );
  }
  if (!model) return <PageSkeleton />;
  const remove = (): void =>
    hide.mutate(
      model.id,
      intoBin(model.name, () => restore.mutateAsync({ kind: "hand_model", ids: [model.id] }), () => void navigate("/models")),
    );
  return (
    <div className="page">
      <Group justify="space-between" align="flex-start" mb="lg" wrap="nowrap">
        <div style={{ minWidth: 0 }}>
          <Group gap="md" wrap="nowrap">
            <Title order={1} className="few-lines" title={model.name}>
              {model.name}
            </Title>
            <ModelKind model={model} />
          </Group>
          <Group gap="sm" mt={4}>
            <HandBadge hand={model.side} />
            {parent && (
              <Text size="sm" className="quiet">
                trained from{" "}
                <Link to={`/models/${parent.id}`} className={classes.link}>
                  {parent.name}
                </Link>
              </Text>
            )}
            {model.created_at && (
              <Text size="sm" className="quiet">
                {formatAgo(model.created_at)}
                {model.created_by_name ? ` by ${model.created_by_name}` : ""}
              </Text>
            )}
          </Group>
        </div>
        <Group gap="sm" wrap="nowrap">
          <ModelDownloads model={model} />
          {model.registers && (
            <For role="reviewer">
              <Button variant="default" onClick={training.open}>
                Train …
              </Button>
              <Menu position="bottom-end">
                <Menu.Target>
                  <Button leftSection={<IconRefresh size={16} aria-hidden />} rightSection={<IconChevronDown size={14} aria-hidden />}>
                    Register again
                  </Button>
                </Menu.Target>
                <Menu.Dropdown>
                  <Menu.Item onClick={registering.open}>Register scans with this model …</Menu.Item>
                  <Menu.Item onClick={looping.open}>The loop: register, train, again …</Menu.Item>
                </Menu.Dropdown>
              </Menu>
            </For>
          )}
          {model.kind !== "default" && (
            <For role="lead">
              <Button variant="default" loading={hide.isPending} onClick={remove} leftSection={<IconTrash size={16} aria-hidden />}>
                Delete
              </Button>
            </For>
          )}
        </Group>
      </Group>
      <div className={classes.columns}>
        <Stack gap="lg" style={{ minWidth: 0 }}>
          <div className={classes.facts}>
            <Fact label="Vertices, triangles">
              {model.vertices.toLocaleString("en")}, {model.faces.toLocaleString("en")}
            </Fact>
            <Fact label="Bones">{model.bones.length}</Fact>
            <Fact label="Shape components">{model.shape_parameters.length}</Fact>
            <Fact label="Pose components">{model.pose_components || "none"}</Fact>
            <Fact label="Pose blend shapes">{model.has_pose_shapes ? "yes" : "no"}</Fact>
            <Fact label="Registrations by it">{model.registration_count.toLocaleString("en")}</Fact>
            {report?.registrations !== null && report && <Fact label="Learnt from">{report.registrations?.toLocaleString("en")}</Fact>}
            {report?.residualMm !== null && report && <Fact label="Distance to them, rms">{formatNumber(report.residualMm, 2)} mm</Fact>}
          </div>
          {model.kind !== "default" && <LiveModel key={model.id} model={model} />}
          {raw.error && (
            <Text size="sm" c="var(--bad-text)" role="alert">
              The report could not be loaded: {raw.error.message}
            </Text>
          )}
          {report && <ReportPlots report={report} />}
        </Stack>
        <Stack gap="lg" style={{ minWidth: 0 }}>
          {model.kind !== "default" && <LineageList kind="hand_model" id={model.id} />}
          <section aria-label="Where it comes from">
            <Title order={3} mb="sm">
              Origin
            </Title>
            <Stack gap="sm">
              {Object.entries(model.provenance).map(([name, text]) => (
                <div key={name}>
                  <Text size="xs" className="quiet">
                    {formatName(name)}
                  </Text>
                  <Text size="sm" style={{ overflowWrap: "anywhere" }}>
                    {text}
                  </Text>
                </div>
              ))}
              {model.digest && (
                <div>
                  <Text size="xs" className="quiet">
                    SHA-256
                  </Text>
                  <Text size="xs" ff="monospace" style={{ overflowWrap: "anywhere" }}>
                    {model.digest}
                  </Text>
                </div>
              )}
            </Stack>
          </section>
        </Stack>
      </div>
      <RegisterDialog isOpen={isRegistering} onClose={registering.close} scanIds={[]} modelId={model.id} />
      <TrainDialog isOpen={isTraining} onClose={training.close} modelId={model.registration_count > 0 ? model.id : undefined} />
      <LoopDialog isOpen={isLooping} onClose={looping.close} model={model} />
    </div>
  );
}
