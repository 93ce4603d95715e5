import { expect, test } from "vitest";
import type { DroppedFile } from "../api/imports";
import { addFilms, groupFilms, listFaults, nameFiles } from "./films";

const file = (path: string): DroppedFile => ({ path, file: new File(["x"], path.split("/").at(-1) ?? path) });

test("each video, archive and folder of images is one camera, in the order people expect", () => {
  const { films, rest } = groupFilms([file("set/cam10.mp4"), file("set/cam2.MOV"), file("set/wide/0.png"), file("set/wide/1.png"), file("set/side.zip"), file("set/notes.txt")]);
  expect(films.map(({ name, kind, files }) => [name, kind, files.length])).toEqual([
    ["cam2", "video", 1],
    ["cam10", "video", 1],
    ["side", "archive", 1],
    ["wide", "images", 2],
  ]);
  expect(rest.map(({ path }) => path)).toEqual(["set/notes.txt"]);
});

test("files that are called alike take the names of their folders", () => {
  const { films } = groupFilms([file("left/GOPR1.mp4"), file("right/GOPR1.mp4")]);
  expect(films.map(({ name }) => name)).toEqual(["left", "right"]);
});

test("one archive alone may hold all cameras, and no longer does beside others", () => {
  const { films } = groupFilms([file("all.zip")]);
  expect(listFaults(films, 16)).toEqual([]);
  expect(nameFiles(films, []).map(({ path }) => path)).toEqual(["all.zip"]);
  const more = addFilms(films, groupFilms([file("cam1.mp4")]).films);
  expect(more.map(({ kind }) => kind)).toEqual(["archive", "video"]);
  expect(addFilms(more, groupFilms([file("cam1.mp4")]).films)).toHaveLength(2);
});

test("all that is wrong is said at once", () => {
  const one = groupFilms([file("a.mp4")]).films;
  expect(listFaults(one, 16)).toEqual(["1 camera; needed 2 to 16: one video, folder of images or .zip for each."]);
  const many = Array.from({ length: 17 }, (_, number) => groupFilms([file(`cam${number}.mp4`)]).films).flat();
  const renamed = many.map((film, place) => (place === 1 ? { ...film, name: "CAM0" } : place === 2 ? { ...film, name: "a/b" } : film));
  expect(listFaults(renamed, 16)).toEqual([
    "17 cameras; needed 2 to 16: calibrate them in groups that share a camera.",
    "CAM0: two cameras have this name; rename one of them.",
    "a/b: cannot be a camera's name; take letters and digits.",
  ]);
});

test("files are sent under the names of the cameras, lenses in a folder of their own", () => {
  const films = groupFilms([file("x/GOPR1.mp4"), file("y/0.png"), file("y/1.png")]).films.map((film) => ({ ...film, name: film.kind === "video" ? "left " : "right" }));
  expect(nameFiles(films, [file("old/cameras.toml")]).map(({ path }) => path)).toEqual(["left.mp4", "right/0.png", "right/1.png", "lenses/cameras.toml"]);
});
