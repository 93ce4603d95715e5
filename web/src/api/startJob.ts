/** What jobs can be asked for, each by its kind, and asking for one. */

import { useMutation, useQueryClient } from "@tanstack/react-query";
import { request } from "./client";
import { jobKeys, takeIn } from "./jobs";
import type { components } from "./schema";
import type { Job } from "./types";

type Schemas = components["schemas"];

/** A request's body of which only some parts are needed: for the others the server has a value of its own. */
type Asked<Body extends { kind: string }, Needed extends keyof Body = never> = Pick<Body, "kind" | Needed> & Partial<Body>;
type WithOptions<Body> = Omit<Body, "options"> & { options?: Partial<Schemas["TrainingParams"]> };

export type RegisterWish = Asked<Schemas["RegisterJobCreate"]>;
export type TrainWish = WithOptions<Asked<Schemas["TrainJobCreate"], "name">>;
export type LoopWish = WithOptions<Asked<Schemas["LoopJobCreate"], "name">>;
export type RegisterMovingWish = Asked<Schemas["RegisterMovingJobCreate"], "moving_scan_id">;
export type JobWish =
  | Asked<Schemas["JobCreate"], "sequence_id">
  | Asked<Schemas["DetectJobCreate"], "sequence_id">
  | Asked<Schemas["CalibrateJobCreate"], "calibration_id">
  | RegisterWish
  | RegisterMovingWish
  | TrainWish
  | LoopWish;

/** What is loaded again when a job of a kind is queued, beside the lists of jobs. */
const CHANGED: Record<JobWish["kind"], readonly string[]> = {
  track: [],
  detect: [],
  calibrate: ["calibrations"],
  register_moving: ["moving-scans"],
  register: ["registrations", "hand-models"],
  train: ["registrations", "hand-models"],
  loop: ["registrations", "hand-models"],
};

/** Queue a job. */
export function useStartJob() {
  const client = useQueryClient();
  return useMutation({
    mutationFn: (wish: JobWish) => request<Job>("POST", "/jobs", { body: wish }),
    onSuccess: (job, { kind }) => {
      takeIn(client, job);
      return Promise.all([jobKeys.all, ...CHANGED[kind].map((key) => [key])].map((queryKey) => client.invalidateQueries({ queryKey })));
    },
  });
}
