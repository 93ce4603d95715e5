import { Alert, Button, FileButton, Group, SegmentedControl, Stack, Text, Title } from "@mantine/core";
import { IconRun } from "@tabler/icons-react";
import { useMemo, useState } from "react";
import { frameOf, POPULATIONS, useBody, useBodyFaces, useBodyPose, useReadMotion, type Population } from "../../api/bodies";
import { AT_REST, frameOfSetting } from "../../model/bodyPose";
import { Failure } from "../parts/Failure";
import { PageSkeleton } from "../parts/PageSkeleton";
import { useTitle } from "../parts/useTitle";
import { BodyMenus } from "./BodyMenus";
import classes from "./BodyPage.module.css";
import { BodySliders } from "./BodySliders";
import { BodyView } from "./BodyView";
import { MotionBar } from "./MotionBar";
import { useMotion, type OpenMotion } from "./useMotion";

const NAMES: Record<Population, string> = { neutral: "Everybody", female: "Women", male: "Men" };

/** The body with hands: its shape, poses and motions, and files of them. */
export default function BodyPage() {
  useTitle("Body with hands");
  const [population, setPopulation] = useState<Population>("neutral");
  const [shape, setShape] = useState<readonly number[]>([]);
  const [setting, setSetting] = useState(AT_REST);
  const [open, setOpen] = useState<OpenMotion | null>(null);
  const reading = useReadMotion();
  const { data: body, error, refetch } = useBody(population);
  const { data: faces, error: facesError } = useBodyFaces();
  const motion = useMotion(open, population);
  const set = useMemo(() => frameOfSetting(setting), [setting]);
  const posed = useBodyPose(population, shape, set);
  const failure = error ?? facesError;
  if (failure && !body) return <Failure what="The body could not be loaded" error={failure} onRetry={() => void refetch()} />;
  if (!body) return <PageSkeleton />;

  const read = (file: File | null): void => {
    if (!file) return;
    reading.mutate(file, {
      onSuccess: (found) => {
        setPopulation(found.population);
        setOpen({ id: crypto.randomUUID(), name: file.name, motion: found });
      },
    });
  };
  const trouble = reading.error ?? posed.error ?? motion.failure;
  return (
    <div className="page">
      <Group justify="space-between" mb="lg" gap="md">
        <Group gap="md" align="center">
          <Title order={1}>Body with hands</Title>
          <SegmentedControl size="xs" aria-label="Whose mean and deviations" data={POPULATIONS.map((value) => ({ value, label: NAMES[value] }))} value={population} onChange={(value) => setPopulation(value)} />
        </Group>
        <Group gap="sm">
          <FileButton accept=".npz" onChange={read}>
            {(props) => (
              <Button {...props} variant="default" loading={reading.isPending} leftSection={<IconRun size={16} aria-hidden />}>
                Open motion …
              </Button>
            )}
          </FileButton>
          <BodyMenus population={population} shape={open ? open.motion.shape : shape} frame={open ? frameOf(open.motion, motion.frame) : set} open={open} />
        </Group>
      </Group>
      {trouble && (
        <Alert color="red" mb="md" title={reading.error ? "The motion could not be read" : "The body could not be posed"} withCloseButton={Boolean(reading.error)} onClose={reading.reset}>
          {trouble.message}
        </Alert>
      )}
      <section className="card" aria-label="The body" style={{ overflow: "hidden" }}>
        <div className={classes.stage}>
          <BodyView vertices={open ? motion.vertices : posed.data} faces={faces} />
          {!open && <BodySliders shape={shape} onShape={setShape} setting={setting} onSetting={setSetting} />}
        </div>
        {open && <MotionBar open={open} state={motion} onClose={() => setOpen(null)} />}
      </section>
      <Stack gap={4} className={classes.about}>
        <Text size="sm">
          {body.vertices.toLocaleString("en")} vertices, {body.joints.length} joints in SMPL-H’s order, {body.shape_count} directions of shape for body and hands together, {body.hand_component_count} directions of pose for each hand. Shapes are in
          standard deviations of {population === "neutral" ? "everybody" : NAMES[population].toLowerCase()}.
        </Text>
        <Text size="xs" className="quiet">
          A motion is an .npz with 156 numbers a frame, as AMASS keeps them. It is posed here and not stored. Licence of the model: {body.provenance["license"] ?? "see the documentation"}.
        </Text>
      </Stack>
    </div>
  );
}
