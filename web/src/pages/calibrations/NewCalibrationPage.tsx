import { Box, Button, Group, Stack, Text, TextInput, Title } from "@mantine/core";
import { IconLock } from "@tabler/icons-react";
import { useEffect } from "react";
import { Link, useNavigate } from "react-router";
import { useCalibrationForm, type CalibrationForm } from "../../api/calibrations";
import { formatBytes, formatCount } from "../../model/format";
import { hasRole, useMe } from "../../state/me";
import { listFaults } from "../../model/films";
import { changeFilmUpload, endFilmUpload, sendChosenFilms, stopFilmUpload, useFilmUpload, type FilmUpload } from "../../state/filmUpload";
import { EmptyState } from "../parts/EmptyState";
import { Failure } from "../parts/Failure";
import { PageSkeleton } from "../parts/PageSkeleton";
import { Refusal } from "../parts/Refusal";
import { Sending } from "../parts/Sending";
import { Sentences } from "../parts/Sentences";
import { useTitle } from "../parts/useTitle";
import { BoardForm } from "./BoardForm";
import classes from "./calibrations.module.css";
import { FilmChoice } from "./FilmChoice";
import { OptionsForm } from "./OptionsForm";

function SendingFilms({ upload, sent }: { upload: FilmUpload; sent: number }) {
  const bytes = upload.films.reduce((sum, film) => sum + film.bytes, 0);
  return (
    <Box maw={640} mx="auto" mt={64} className="card" p="xl">
      <Sending sent={sent} title={<Title order={2}>{sent === 1 ? "Checking the films" : "Sending the films"}</Title>} onCancel={stopFilmUpload}>
        <Text className="quiet">
          {formatCount(upload.films.length, "film")}, {formatBytes(bytes)}. {sent === 1 ? "The first picture of each is looked at." : "Stay on any page of the studio until they have arrived."}
        </Text>
      </Sending>
    </Box>
  );
}

function Choosing({ form, upload }: { form: CalibrationForm; upload: FilmUpload }) {
  const options = upload.options ?? form.defaults;
  const faults = listFaults(upload.films, form.most_cameras);
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        void sendChosenFilms(options);
      }}
    >
      <div className={classes.columns}>
        <Stack gap="md">
          <FilmChoice films={upload.films} lenses={upload.lenses} mostCameras={form.most_cameras} onFilms={(films) => changeFilmUpload({ films })} onLenses={(lenses) => changeFilmUpload({ lenses })} />
          <OptionsForm options={options} onChange={(next) => changeFilmUpload({ options: next })} />
        </Stack>
        <BoardForm form={form} board={options.board} onChange={(board) => changeFilmUpload({ options: { ...options, board } })} />
        <Stack gap="md">
          {upload.films.length > 0 && <Sentences title="Before the films can be sent" sentences={faults} isProblem />}
          {upload.failure && <Refusal error={upload.failure} after="Nothing was kept; what you chose is still here." />}
          <Group align="flex-end" gap="sm" className={`card ${classes.card}`}>
            <TextInput label="Name of the calibration" value={upload.name} maxLength={200} required flex={1} onChange={(event) => changeFilmUpload({ name: event.currentTarget.value })} />
            <Button type="submit" disabled={upload.films.length === 0 || faults.length > 0 || !upload.name.trim()}>
              Send and check
            </Button>
          </Group>
        </Stack>
      </div>
    </form>
  );
}

function ForLeads() {
  return (
    <EmptyState
      icon={<IconLock size={40} stroke={1.5} />}
      title="Leads calibrate cameras"
      action={
        <Button variant="default" component={Link} to="/calibrations">
          To the calibrated cameras
        </Button>
      }
    >
      Ask a lead to send the films of the board, or to change your role.
    </EmptyState>
  );
}

/** From films of a board to an upload that is checked. */
export default function NewCalibrationPage() {
  useTitle("Calibrate cameras");
  const upload = useFilmUpload();
  const { data: form, error, refetch } = useCalibrationForm();
  const navigate = useNavigate();
  const done = upload.result?.id;
  useEffect(() => {
    if (!done) return;
    void navigate(`/calibrations/${done}`, { replace: true });
    endFilmUpload();
  }, [done, navigate]);
  if (!hasRole(useMe(), "lead")) return <ForLeads />;
  if (error && !form) return <Failure what="The form could not be loaded" error={error} safe="Calibrations that were made are untouched." onRetry={() => void refetch()} />;
  if (!form) return <PageSkeleton />;
  return (
    <div className="page">
      <Group justify="space-between" mb="lg" align="flex-start" wrap="nowrap">
        <div style={{ minWidth: 0 }}>
          <Title order={1}>Calibrate cameras</Title>
          <Text className="quiet" mt={4} maw={880}>
            Let all cameras film while somebody moves a board slowly through the place where the hands will be: tilted in several directions, near and far, into the corners of every picture, and for a while where two cameras see it at once. Half a
            minute is enough.
          </Text>
        </div>
        <Button variant="default" component={Link} to="/calibrations" style={{ flexShrink: 0 }}>
          All calibrations
        </Button>
      </Group>
      {upload.sent === null ? <Choosing form={form} upload={upload} /> : <SendingFilms upload={upload} sent={upload.sent} />}
    </div>
  );
}
