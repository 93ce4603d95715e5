/** What somebody has chosen as the films of cameras: which files are which camera's, and what keeps them from being sent. */

import type { DroppedFile } from "../api/imports";
import { formatCount } from "./format";

export const VIDEO_SUFFIXES = [".mp4", ".m4v", ".mov", ".avi", ".mkv", ".webm"];
export const IMAGE_SUFFIXES = [".png", ".jpg", ".jpeg"];
export const LENS_SUFFIXES = [".toml", ".yaml", ".yml", ".json", ".npz", ".dat", ".txt"];

/** One camera's film. `whole` is an archive that holds all cameras. */
export interface Film {
  readonly key: string;
  readonly name: string;
  readonly kind: "video" | "images" | "archive" | "whole";
  readonly files: readonly DroppedFile[];
  readonly bytes: number;
}

const endsWith = (path: string, suffixes: readonly string[]): boolean => suffixes.some((suffix) => path.toLowerCase().endsWith(suffix));
const lastOf = (path: string): string => path.split("/").at(-1) ?? path;
const stemOf = (path: string): string => lastOf(path).replace(/\.[^.]+$/, "");
const folderOf = (path: string): string => path.split("/").slice(0, -1).join("/");

const makeFilm = (key: string, name: string, kind: Film["kind"], files: readonly DroppedFile[]): Film => ({
  key,
  name,
  kind,
  files,
  bytes: files.reduce((sum, { file }) => sum + file.size, 0),
});

const inOrder = new Intl.Collator("en", { numeric: true });

/** Each video, each archive and each folder of images is a camera's; the rest is nobody's. */
export function groupFilms(files: readonly DroppedFile[]): { films: Film[]; rest: DroppedFile[] } {
  const single = files.filter(({ path }) => endsWith(path, [...VIDEO_SUFFIXES, ".zip"]));
  const images = new Map<string, DroppedFile[]>();
  for (const one of files) if (endsWith(one.path, IMAGE_SUFFIXES)) images.set(folderOf(one.path), [...(images.get(folderOf(one.path)) ?? []), one]);
  const rest = files.filter(({ path }) => !endsWith(path, [...VIDEO_SUFFIXES, ...IMAGE_SUFFIXES, ".zip"]));
  const [first] = single;
  if (first && files.length === 1 && endsWith(first.path, [".zip"])) return { films: [makeFilm(first.path, stemOf(first.path), "whole", [first])], rest };
  const stems = single.map(({ path }) => stemOf(path));
  const films = [
    ...single.map((one) => {
      // Cameras that write into folders of their own often call their files alike.
      const isAlike = stems.filter((stem) => stem === stemOf(one.path)).length > 1 && folderOf(one.path) !== "";
      const name = isAlike ? lastOf(folderOf(one.path)) : stemOf(one.path);
      return makeFilm(one.path, name, endsWith(one.path, [".zip"]) ? "archive" : "video", [one]);
    }),
    ...[...images].map(([folder, own]) => makeFilm(`${folder}/`, lastOf(folder) || "images", "images", own)),
  ];
  return { films: films.sort((a, b) => inOrder.compare(a.name, b.name)), rest };
}

/** Films as they were, then new ones; a file that was chosen before is not taken twice. An archive of all stands alone. */
export function addFilms(films: readonly Film[], more: readonly Film[]): Film[] {
  const known = new Set(films.map(({ key, bytes }) => `${key} ${bytes}`));
  const own = films.map((film) => (film.kind === "whole" ? { ...film, kind: "archive" as const } : film));
  const fresh = more.filter(({ key, bytes }) => !known.has(`${key} ${bytes}`));
  return films.length === 0 ? fresh : [...own, ...fresh.map((film) => (film.kind === "whole" ? { ...film, kind: "archive" as const } : film))];
}

/** What keeps films from being sent, all of it at once. */
export function listFaults(films: readonly Film[], mostCameras: number): string[] {
  if (films.some(({ kind }) => kind === "whole")) return [];
  const faults = [];
  if (films.length < 2 || films.length > mostCameras) {
    faults.push(`${formatCount(films.length, "camera")}; needed 2 to ${mostCameras}${films.length > 2 ? ": calibrate them in groups that share a camera" : ": one video, folder of images or .zip for each"}.`);
  }
  const names = films.map(({ name }) => name.trim().toLowerCase());
  const twice = films.filter(({ name }, place) => names.indexOf(name.trim().toLowerCase()) < place);
  for (const { name } of twice) faults.push(`${name}: two cameras have this name; rename one of them.`);
  for (const { name } of films) {
    if (!name.trim()) faults.push("A camera has no name.");
    else if (/[/\\:]/.test(name) || /^[.\s]|[.\s]$/.test(name) || name.trim().toLowerCase() === "lenses") faults.push(`${name}: cannot be a camera's name; take letters and digits.`);
  }
  return faults;
}

/** Files under the names by which the server tells cameras apart. */
export function nameFiles(films: readonly Film[], lenses: readonly DroppedFile[]): DroppedFile[] {
  const own = films.flatMap(({ name, kind, files }) =>
    files.map(({ path, file }) => {
      if (kind === "whole") return { path: lastOf(path), file };
      const suffix = lastOf(path).slice(stemOf(path).length);
      return { path: kind === "images" ? `${name.trim()}/${lastOf(path)}` : `${name.trim()}${suffix}`, file };
    }),
  );
  return [...own, ...lenses.map(({ path, file }) => ({ path: `lenses/${lastOf(path)}`, file }))];
}
