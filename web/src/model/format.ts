/** Numbers and times as people read them. */

/** "0.3 s", "1:05", "2 h 03 min". */
export function formatDuration(seconds: number): string {
  if (seconds < 9.95) return `${Math.max(0, seconds).toFixed(1)} s`;
  const whole = Math.max(0, Math.round(seconds));
  if (whole < 3600) return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, "0")}`;
  return `${Math.floor(whole / 3600)} h ${String(Math.floor((whole % 3600) / 60)).padStart(2, "0")} min`;
}

/** What is left of something that runs; "0.0 s left" of what is not done yet would be no true word. */
export const formatLeft = (seconds: number): string => (seconds < 1 ? "almost done" : `${formatDuration(seconds)} left`);

/** "2 minutes ago", and the date when that is longer than a week. */
export function formatAgo(time: string, now: number = Date.now()): string {
  const seconds = (now - Date.parse(time)) / 1000;
  if (!Number.isFinite(seconds)) return "";
  if (seconds < 45) return "just now";
  const minutes = Math.round(seconds / 60);
  if (minutes < 60) return minutes === 1 ? "1 minute ago" : `${minutes} minutes ago`;
  const hours = Math.round(minutes / 60);
  if (hours < 24) return hours === 1 ? "1 hour ago" : `${hours} hours ago`;
  const days = Math.round(hours / 24);
  if (days < 8) return days === 1 ? "yesterday" : `${days} days ago`;
  return new Date(time).toLocaleDateString();
}

/** A number with few digits, or a dash when there is none. */
export const formatNumber = (value: number | null | undefined, digits = 1): string =>
  value === null || value === undefined || !Number.isFinite(value) ? "–" : value.toFixed(digits);

/** A number with its unit; a dash alone when there is none. */
export const formatMeasure = (value: number | null | undefined, unit: string, digits = 1): string => {
  const number = formatNumber(value, digits);
  return number === "–" ? number : `${number} ${unit}`;
};

/** Three digits of a number of any size, never as a power of ten. */
export const formatRough = (value: number): string => value.toLocaleString("en", { maximumSignificantDigits: 3 });

export const formatCount = (count: number, one: string, many = `${one}s`): string => `${count.toLocaleString("en")} ${count === 1 ? one : many}`;

export function formatBytes(bytes: number): string {
  const units = ["B", "kB", "MB", "GB"];
  let size = bytes;
  let unit = 0;
  while (size >= 1000 && unit < units.length - 1) {
    size /= 1000;
    unit += 1;
  }
  return `${unit === 0 ? size : size.toFixed(size < 10 ? 1 : 0)} ${units[unit]}`;
}

/** "depth_residual_mm" or "depth-residual" as words. */
export const formatName = (name: string): string => name.replaceAll(/[_-]+/g, " ").replace(/^./, (letter) => letter.toUpperCase());

const FORMATS: Record<string, string> = {
  recording_folder: "Handloom's own folder",
  rgbd_folder: "RGB-D images in a folder",
  synced_videos: "synchronised videos",
  tum_rgbd: "TUM RGB-D",
};

/** What files were read as, in people's words. */
export const formatFileFormat = (name: string): string => FORMATS[name] ?? formatName(name).toLowerCase();

/** A picture's file without its folders; of a film, which frame of it. */
export function formatPicture(name: string): string {
  const file = name.split("/").at(-1) ?? name;
  const [, film, frame] = /^(.+)#([0-9]+)$/.exec(file) ?? [];
  return film === undefined ? file : `Frame ${frame} of ${film}`;
}

const JOB_WORDS: Record<string, string> = { detect: "Find hands in", calibrate: "Calibrate", register_moving: "Register" };

/** What a job does, before the name of what it does it to: "Track", "Find hands in". */
export const formatJobKind = (kind: string): string => JOB_WORDS[kind] ?? formatName(kind);

/** "one, two and three". */
export const joinWords = (words: readonly string[]): string => words.length < 2 ? words.join("") : `${words.slice(0, -1).join(", ")} and ${words.at(-1)}`;
