import { ActionIcon, Button, FileButton, Group, Stack, Text, TextInput, Title, Tooltip } from "@mantine/core";
import { IconFileZip, IconMovie, IconPhoto, IconTrash, IconUpload } from "@tabler/icons-react";
import { useRef } from "react";
import { readChoice } from "../../actions/readDrop";
import type { DroppedFile } from "../../api/imports";
import { addFilms, groupFilms, IMAGE_SUFFIXES, LENS_SUFFIXES, VIDEO_SUFFIXES, type Film } from "../../model/films";
import { formatBytes, formatCount } from "../../model/format";
import { DropTarget } from "../parts/DropTarget";
import classes from "./calibrations.module.css";

interface FilmChoiceProps {
  films: readonly Film[];
  lenses: readonly DroppedFile[];
  mostCameras: number;
  onFilms: (films: Film[]) => void;
  onLenses: (lenses: DroppedFile[]) => void;
}

const ICONS = { video: IconMovie, images: IconPhoto, archive: IconFileZip, whole: IconFileZip } as const;

function describe({ kind, files, bytes }: Film): string {
  const size = formatBytes(bytes);
  if (kind === "images") return `${formatCount(files.length, "image")}, ${size}`;
  return `${files[0]?.path.split("/").at(-1) ?? ""}, ${size}${kind === "whole" ? "; holds all cameras" : ""}`;
}

/** One film for each camera, dropped or chosen, and what the cameras are called. */
export function FilmChoice({ films, lenses, mostCameras, onFilms, onLenses }: FilmChoiceProps) {
  const folder = useRef<HTMLInputElement>(null);
  const take = (files: readonly DroppedFile[]): void => onFilms(addFilms(films, groupFilms(files).films));
  const rename = (key: string, name: string): void => onFilms(films.map((film) => (film.key === key ? { ...film, name } : film)));
  return (
    <Stack gap="md" className={`card ${classes.card}`} component="section" aria-label="The cameras" data-takes-drops>
      <DropTarget title="Drop the films of the cameras" hint="A video, a folder of images or a .zip for each camera." onFiles={take} />
      <Title order={2}>The cameras</Title>
      <div className={classes.drop}>
        <Text size="sm" className="quiet">
          Drop one video, folder of images or .zip for each camera here: 2 to {mostCameras}, all of the same time, of any sizes and frame rates.
        </Text>
        <Group gap="sm" justify="center">
          <FileButton multiple accept={[...VIDEO_SUFFIXES, ".zip", ...IMAGE_SUFFIXES].join(",")} onChange={(chosen) => take(chosen.map((file) => ({ path: file.name, file })))} inputProps={{ "aria-label": "Films of the cameras" }}>
            {(props) => (
              <Button {...props} variant="default" leftSection={<IconUpload size={16} aria-hidden />}>
                Choose videos …
              </Button>
            )}
          </FileButton>
          <Button variant="default" onClick={() => folder.current?.click()}>
            Choose a folder …
          </Button>
        </Group>
      </div>
      <input
        ref={(element) => {
          folder.current = element;
          element?.setAttribute("webkitdirectory", "");
        }}
        type="file"
        multiple
        hidden
        aria-label="Folder with the films"
        onChange={(event) => {
          if (event.target.files) take(readChoice(event.target.files));
          event.target.value = "";
        }}
      />
      {films.length > 0 && (
        <Stack gap="sm" role="list" aria-label="Films">
          {films.map((film) => {
            const Icon = ICONS[film.kind];
            return (
              <div key={film.key} className={classes.film} role="listitem">
                <Icon size={18} aria-hidden />
                <TextInput size="xs" aria-label={`Name of the camera of ${film.key}`} value={film.name} maxLength={100} onChange={(event) => rename(film.key, event.currentTarget.value)} disabled={film.kind === "whole"} />
                <Text size="sm" className="quiet one-line" title={film.key}>
                  {describe(film)}
                </Text>
                <Tooltip label="Leave this camera out">
                  <ActionIcon aria-label={`Leave ${film.name} out`} onClick={() => onFilms(films.filter(({ key }) => key !== film.key))}>
                    <IconTrash size={16} />
                  </ActionIcon>
                </Tooltip>
              </div>
            );
          })}
        </Stack>
      )}
      <Group gap="sm">
        <FileButton multiple accept={LENS_SUFFIXES.join(",")} onChange={(chosen) => onLenses(chosen.map((file) => ({ path: file.name, file })))} inputProps={{ "aria-label": "File of known lenses" }}>
          {(props) => (
            <Button {...props} variant="default" size="compact-sm">
              Known lenses …
            </Button>
          )}
        </FileButton>
        <Text size="xs" className="quiet" style={{ overflowWrap: "anywhere" }}>
          {lenses.length > 0 ? `${lenses.map(({ path }) => path).join(", ")}: kept as they are, by the cameras’ names.` : "Optional. An earlier calibration whose cameras have the same names; its lenses are kept."}
        </Text>
        {lenses.length > 0 && (
          <Button variant="subtle" size="compact-sm" onClick={() => onLenses([])}>
            Without them
          </Button>
        )}
      </Group>
    </Stack>
  );
}
