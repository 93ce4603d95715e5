/** The resources of `/api/v1`, under the names the pages use. */

export type Side = "right" | "left";

export interface Camera {
  id: string;
  width: number;
  height: number;
  K: number[][];
  distortion: number[];
  T_world_camera: number[][];
  has_color: boolean;
  has_depth: boolean;
  depth_scale: number | null;
}

/** What the server found in an import; problems and warnings are sentences for people. */
export interface ImportReport {
  ok: boolean;
  format: string;
  name: string;
  fps: number | null;
  frame_count: number;
  cameras: CameraReport[];
  hands: string[];
  objects: string[];
  annotations: number;
  baselines_m: Record<string, number>;
  problems: string[];
  warnings: string[];
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
  depth: { sampled_frames: number; empty_frames: number; zero_share: number; saturated_share: number; percentiles_m: number[] } | null;
  calibration: {
    field_of_view_deg: number[];
    principal_offset: number[];
    rotation_error: number;
    distortion: number;
    centre_m: number[];
  } | null;
}

export interface Recording {
  id: string;
  name: string;
  fps: number;
  frame_count: number;
  cameras: Camera[];
  hands: string[];
  objects: { name: string }[];
  created_at: string;
  revision: number;
  report: ImportReport | null;
  annotated_frames: number;
  best_track: BestTrack | null;
  content_key: string;
}

export interface BestTrack {
  id: string;
  summary: TrackSummary;
  error_px: number | null;
}

export interface Page<T> {
  items: T[];
  next_cursor: string | null;
}

export interface Import {
  id: string;
  state: "checked" | "refused" | "confirmed";
  /** Proposed for the recording. */
  name: string;
  /** What has been told about it so far. */
  options: Record<string, unknown>;
  report: ImportReport;
  file_count: number;
  byte_count: number;
  sequence_id: string | null;
  created_at: string;
}

export interface HandSkeleton {
  joints: string[];
  edges: [number, number][];
  fingers: string[];
}

/** Image pixels, (0, 0) at the centre of the top-left pixel; v is 0 absent, 1 occluded, 2 visible. */
export type WirePoint = [x: number, y: number, v: number];

export interface Annotation {
  frame: number;
  camera: string;
  hand: Side;
  points: WirePoint[];
  revision: number;
  updated_at: string;
  author: string | null;
}

export type JobState = "queued" | "running" | "succeeded" | "failed" | "cancelled";

export interface Job {
  id: string;
  kind: string;
  state: JobState;
  progress: number;
  stage: string | null;
  frames_done: number | null;
  frames_total: number | null;
  seconds_left: number | null;
  params: Record<string, unknown>;
  sequence_id: string | null;
  track_id: string | null;
  error: string | null;
  created_at: string;
  started_at: string | null;
  ended_at: string | null;
}

export interface LogLine {
  n: number;
  time: string;
  level: string;
  text: string;
}

export interface FormField {
  name: string;
  type: "integer" | "number" | "boolean" | "text";
  default: unknown;
  help: string;
  choices: string[] | null;
}

export interface TrackSummary {
  frames: number;
  lost: number;
  median_ms: number | null;
  p95_ms: number | null;
  stages_ms: Record<string, number> | null;
  depth_residual_mm: number | null;
  silhouette_iou: number | null;
  threads: number | null;
}

export interface Track {
  id: string;
  sequence_id: string;
  job_id: string | null;
  name: string;
  frame_first: number;
  frame_count: number;
  summary: TrackSummary;
  created_at: string;
  hands: string[];
  error_px: number | null;
}

export interface TrackFrames {
  frame: number[];
  status: ("ok" | "lost" | "recovered")[];
  seconds: (number | null)[];
  depth_residual_mm: (number | null)[];
  silhouette_iou: (number | null)[];
  iterations: (number | null)[];
}

export interface TrackJoints {
  joint_names: string[];
  frames: number[];
  /** px; null behind the camera */
  points: (number | null)[][][];
}

export interface ViewerSession {
  id: string;
  url: string;
  /** Correspondences of the frame that is shown. */
  terms: { name: string; count: number; color: string }[];
}

/** Distance of a track's joints to the annotations, px. */
export interface Evaluation {
  joint_error_px: Statistics;
  joints: (Statistics & { joint: string })[];
  items: EvaluatedItem[];
  annotated: number;
  evaluated: number;
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
