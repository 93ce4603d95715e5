/**
 * The resources of `/api/v1` under the names the pages use. Their types are generated; only what the API hands through
 * from the tracker as free JSON (reports, summaries, evaluations) is described here.
 */

import type { components } from "./schema";

type Schemas = components["schemas"];

export type Side = Schemas["AnnotationOut"]["hand"];
export type Camera = Schemas["SequenceCamera"];
/** Image pixels, (0, 0) at the centre of the top-left pixel; v is 0 absent, 1 occluded, 2 visible. Of answers the API's document says only that they are three numbers. */
export type WirePoint = Schemas["AnnotationPut"]["points"][number];
type WithPoints<T> = Omit<T, "points"> & { points: WirePoint[] };
export type Annotation = WithPoints<Schemas["AnnotationOut"]>;
/** What a person accepted for a joint instead of placing it. */
export type JointSource = Pick<Schemas["JointSourceOut"], "kind"> & Partial<Schemas["JointSourceOut"]>;
/** What one save made of it. */
export type AnnotationRevision = Omit<Schemas["AnnotationRevision"], "points"> & { points: WirePoint[] | null };
export type Job = Schemas["JobOut"];
export type JobState = Job["state"];
export type Batch = Schemas["BatchOut"];
export type BatchMade = Schemas["BatchMade"];
export type BulkAct = Schemas["BulkAct"]["act"];
export type BulkDone = Schemas["BulkDone"];
export type Worker = Schemas["WorkerOut"];
export type LogLine = Schemas["JobLogLine"];
export type JobForm = Schemas["JobForm"];
export type FormField = Schemas["JobFormField"];
export type Preset = Schemas["JobPreset"];
export type TrackFrames = Schemas["TrackFrames"];
/** How a term of the objective is named and drawn. */
export type TermLook = Schemas["TermLook"];
export type FrameEnergy = Schemas["FrameEnergy"];
export type TrackJoints = Schemas["TrackJoints"];
/** A machine's proposal as the server gives it; `model/suggestion.ts` has it as the browser keeps it. */
export type WireSuggestion = Omit<Schemas["Suggestion"], "joints"> & { joints: (Omit<Schemas["SuggestedJoint"], "px"> & { px: [number, number] } | null)[] };
export type Flag = WithPoints<Schemas["FlagOut"]>;
export type FlagPage = Omit<Schemas["FlagPage"], "items"> & { items: Flag[] };
export type HandToLookAt = WithPoints<Schemas["HandToLookAt"]>;
export type QueuePage = Omit<Schemas["QueuePage"], "items"> & { items: HandToLookAt[] };
export type ViewerSession = Schemas["ViewerSessionOut"];

export type Me = Schemas["MyAccount"];
export type Role = Me["role"];
export type Person = Schemas["PersonOut"];
export type PersonAdded = Schemas["PersonAdded"];
export type OneTimeCode = Schemas["CodeOut"];
export type Login = Schemas["LoginOut"];
export type Token = Schemas["TokenOut"];
export type NewToken = Schemas["NewToken"];
export type AuditLine = Schemas["AuditLine"];

export type Recording = Omit<Schemas["SequenceOut"], "report" | "best_track"> & {
  report: ImportReport | null;
  best_track: BestTrack | null;
};
export type BestTrack = Omit<Schemas["BestTrack"], "summary"> & { summary: TrackSummary };
export type Track = Omit<Schemas["TrackOut"], "summary"> & { summary: TrackSummary };
export type Import = Omit<Schemas["ImportOut"], "report"> & { report: ImportReport };

export interface Page<T> {
  items: T[];
  next_cursor: string | null;
}

/** As `summary.json` of a track. */
export interface TrackSummary {
  frames: number;
  lost: number;
  median_ms: number | null;
  p95_ms: number | null;
  stages_ms: Record<string, number> | null;
  depth_residual_mm: number | null;
  silhouette_iou: number | null;
  threads: number | null;
  /** The lab's own fingertip detector; null or missing for the one that comes with Handloom. */
  detector?: { name: string; sha256: string } | null;
  /** What may be wrong with single cameras, in sentences. */
  doubts?: string[];
  /** By camera, medians over frames and hands; empty unless several colour cameras were tracked in. */
  views?: Record<string, { fit_px: number | null; left_out_px: number | null; weight: number | null }>;
}

/** What the server found in an import; problems and warnings are sentences for people. */
/** How large an object's mesh is; no sides when its file knows its unit. */
export interface ObjectReport {
  name: string;
  size_m: number[];
  metres_per_unit: number | null;
  /** The unit was not given; it was recognised by the size. */
  is_guessed: boolean;
}

export interface ImportReport {
  ok: boolean;
  format: string;
  name: string;
  fps: number | null;
  frame_count: number;
  cameras: CameraReport[];
  hands: string[];
  objects: string[];
  /** Absent from reports of older studios. */
  object_sizes?: ObjectReport[];
  annotations: number;
  baselines_m: Record<string, number>;
  problems: string[];
  warnings: string[];
  /** Absent from reports of older studios. */
  questions?: ImportQuestion[];
  sensors?: SensorFit[];
  takes?: string[];
}

/** An option that is missing, ambiguous or cannot be right. */
export interface ImportQuestion {
  field: string;
  label: string;
  kind: "number" | "choice" | "boolean";
  unit: string;
  ask: string;
  /** The report's sentence that the answer mends. */
  problem: string;
  is_required: boolean;
  proposal: unknown;
  proposed_by: string;
  choices: ImportChoice[];
}

export interface ImportChoice {
  value: unknown;
  label: string;
  count: number;
  detail: string;
  pictures: string[];
}

/** A kind of depth camera with images of this size; its values are typical ones. */
export interface SensorFit {
  name: string;
  label: string;
  source: string;
  values: Record<string, number>;
  is_guess: boolean;
}

export interface CameraReport {
  id: string;
  width: number;
  height: number;
  color_frames: number;
  depth_frames: number;
  image_types: Record<string, number>;
  gaps: string[];
  timestamps: { monotonic: boolean; median_interval_s: number; jitter_s: number; dropped: number } | null;
  depth: { sampled_frames: number; empty_frames: number; zero_share: number; saturated_share: number; percentiles_m: number[]; nearest_m?: number | null } | null;
  calibration: {
    field_of_view_deg: number[];
    principal_offset: number[];
    rotation_error: number;
    distortion: number;
    centre_m: number[];
  } | null;
  /** Names of the first, the middle and the last image of each kind. */
  pictures?: Record<string, string[]>;
}

/** Distance of a track's joints to the annotations, px. */
export interface Evaluation {
  joint_error_px: Statistics;
  joints: (Statistics & { joint: string })[];
  items: EvaluatedItem[];
  annotated: number;
  evaluated: number;
  /** Joints that do not count: a track had a part in them. */
  left_out_joints: number;
}

export interface Statistics {
  count: number;
  mean: number | null;
  std: number | null;
  median: number | null;
  max: number | null;
}

export interface EvaluatedItem {
  frame: number;
  camera: string;
  hand: Side;
  status: string;
  mean_px: number | null;
  max_px: number | null;
  joints: number;
}
