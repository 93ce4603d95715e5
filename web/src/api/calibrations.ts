/** Cameras calibrated from filmed boards. */

import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { API, fetchBytes, request, upload } from "./client";
import type { DroppedFile } from "./imports";
import { fetchAll } from "./recordings";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type BoardOptions = Required<Schemas["BoardOptions"]>;
export type CalibrationOptions = Required<Omit<Schemas["CalibrationOptions"], "board">> & { board: BoardOptions };
export type CalibrationForm = Omit<Schemas["CalibrationForm"], "defaults" | "boards"> & {
  defaults: CalibrationOptions;
  boards: (Omit<Schemas["BoardChoice"], "board"> & { board: BoardOptions })[];
};
export type FilmReport = Schemas["FilmReport"];

/** How far a camera's corners are off, px; null where nothing says it. */
export interface Residual {
  rms: number | null;
  median: number | null;
  corners: number;
}

type Sorts = "fitted" | "left_out" | "by_other_cameras";

export interface CalibratedCamera {
  id: string;
  width: number;
  height: number;
  K: number[][];
  /** m */
  T_world_camera: number[][];
  frames: number;
  frames_with_board: number;
  time_offset: { seconds: number; frames: number; known: boolean };
  residual_px: Record<Sorts, Residual>;
}

/** As `report.json` has it, without its boards. */
export interface CalibrationResult {
  world: string;
  board: string;
  residual_px: Record<Sorts, Residual>;
  cameras: CalibratedCamera[];
  warnings: string[];
  files: string[];
}

export interface PlacedBoard {
  /** In the first camera's time. */
  seconds: number;
  left_out: boolean;
  T_world_board: number[][] | null;
  residual_px: Record<string, Residual>;
}

export type Calibration = Omit<Schemas["CalibrationOut"], "result" | "options"> & { result: CalibrationResult | null; options: CalibrationOptions };

const KEY = ["calibrations"] as const;

export const useCalibrationForm = () =>
  useQuery({ queryKey: [...KEY, "form"], queryFn: () => request<CalibrationForm>("GET", "/calibrations/form"), staleTime: Infinity });

export const useCalibrations = () => useQuery({ queryKey: [...KEY, "list"], queryFn: () => fetchAll<Calibration>("/calibrations") });

export const useCalibration = (id: string) =>
  useQuery({ queryKey: [...KEY, "one", id], queryFn: () => request<Calibration>("GET", `/calibrations/${id}`), retry: false });

/** Where the boards were at the moments that were judged; the file never changes. */
export const usePlacedBoards = (id: string) =>
  useQuery({
    queryKey: [...KEY, "boards", id],
    queryFn: async () => (await request<{ boards: PlacedBoard[] }>("GET", `/calibrations/${id}/files/report.json`)).boards,
    staleTime: Infinity,
  });

export const calibrationFileUrl = (id: string, name: string): string => `${API}/calibrations/${id}/files/${name}`;
export const coverageUrl = (id: string, camera: number): string => `${API}/calibrations/${id}/coverage/${camera}.png`;

/** The board as a page to print, or as a picture. */
export const boardUrl = (board: BoardOptions, kind: "pdf" | "png"): string =>
  `${API}/calibrations/board.${kind}?${new URLSearchParams(Object.entries(board).map(([name, value]) => [name, String(value)]))}`;

/** Why there is no such board, in the server's words. */
export const askBoardFault = (board: BoardOptions): Promise<string> =>
  fetchBytes(boardUrl(board, "png")).then(
    () => "The preview could not be shown, but the board is valid.",
    (failure: Error) => failure.message,
  );

export function sendFilms(
  files: readonly DroppedFile[],
  name: string,
  options: CalibrationOptions,
  onProgress: (part: number) => void,
  signal: AbortSignal,
): Promise<Calibration> {
  const form = new FormData();
  form.append("name", name);
  form.append("options", JSON.stringify(options));
  for (const { path, file } of files) form.append("files", file, path);
  return upload<Calibration>("/calibrations", form, onProgress, signal);
}

/** A change after which everything about calibrations is asked for again. */
function useChange<Subject, Result>(act: (subject: Subject) => Promise<Result>) {
  const client = useQueryClient();
  return useMutation({ mutationFn: act, onSuccess: () => client.invalidateQueries({ queryKey: KEY }) });
}

export const useCheckFilms = (id: string) =>
  useChange((options: CalibrationOptions) => request<Calibration>("POST", `/calibrations/${id}/check`, { body: { options } }));

export const useRemoveCalibration = () => useChange((id: string) => request("DELETE", `/calibrations/${id}`));
