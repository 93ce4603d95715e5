/** The unit of a scan's file, and the sizes that it makes: a file does not say its unit. */

export interface Unit {
  readonly label: string;
  readonly metres: number;
}

export const UNITS: readonly Unit[] = [
  { label: "Millimetres", metres: 0.001 },
  { label: "Centimetres", metres: 0.01 },
  { label: "Metres", metres: 1 },
  { label: "Inches", metres: 0.0254 },
];

/** Length of an adult's hand that is drawn beside a scan, m. */
export const HAND_LENGTH = 0.19;

/** "18.4 × 9.2 × 6.1 cm" of sides in metres. */
export function formatSize(sides: readonly number[]): string {
  const cm = sides.map((side) => 100 * side);
  const digits = Math.max(...cm) < 100 ? 1 : 0;
  return `${cm.map((side) => side.toFixed(side < 1 && digits ? 2 : digits)).join(" × ")} cm`;
}

/** "1 unit = 28.5 mm", and the unit's own name where it has one. */
export function formatUnit(metres: number | null): string {
  if (metres === null) return "never said";
  const usual = UNITS.find((unit) => unit.metres === metres);
  return usual ? usual.label.toLowerCase() : `1 unit = ${Number((1000 * metres).toPrecision(6))} mm`;
}

export interface SizeLimits {
  /** Shortest and longest longest side of a hand, m. */
  readonly hand: readonly [number, number];
  /** Longest side of a scan that is still to be cropped, m. */
  readonly scene: number;
}

/** What the server's rule says (tracker/capture/scan_size.py), for pages that have not asked it. */
export const LIMITS: SizeLimits = { hand: [0.08, 0.6], scene: 3 };

export interface SizeVerdict {
  /** `bad` is refused; `crop` is kept and registered once it is cropped. */
  readonly state: "good" | "crop" | "bad";
  readonly text: string;
}

/** Whether a longest side, m, can be that of a hand. */
export function judgeSize(length: number, { hand, scene }: SizeLimits = LIMITS): SizeVerdict {
  const range = `A hand is ${100 * hand[0]} to ${100 * hand[1]} cm long, with its forearm`;
  if (length < hand[0]) return { state: "bad", text: `Too small. ${range}.` };
  if (length > scene) return { state: "bad", text: `Too large. ${range}.` };
  if (length > hand[1]) return { state: "crop", text: `${range}: crop what is around it before it is registered.` };
  return { state: "good", text: "" };
}

/** What somebody said of the files of one upload. */
export interface UnitAnswers {
  /** For all of them; null while nobody said one. */
  readonly all: number | null;
  /** By file, where it is another. */
  readonly own: Readonly<Record<string, number>>;
}

interface Measured {
  readonly file: string;
  readonly metres_per_unit: number | null;
  readonly guess: number | null;
}

/** The unit of a file: as a scans.json says, as somebody said here, else the guess. */
export const unitOf = (one: Measured, { all, own }: UnitAnswers): number | null => one.metres_per_unit ?? own[one.file] ?? all ?? one.guess;

export const isGuess = (one: Measured, { all, own }: UnitAnswers): boolean => one.metres_per_unit === null && own[one.file] === undefined && all === null && one.guess !== null;

/** As an upload says it: the unit of most files, and those that have another. */
export function writeUnits(files: readonly Measured[], answers: UnitAnswers): { metres_per_unit?: number; units?: Record<string, number> } {
  const counts = new Map<number, number>();
  for (const one of files) {
    const unit = unitOf(one, answers);
    if (unit !== null) counts.set(unit, (counts.get(unit) ?? 0) + 1);
  }
  const [most] = [...counts].sort((a, b) => b[1] - a[1]);
  if (!most) return {};
  const units: Record<string, number> = {};
  for (const one of files) {
    const unit = unitOf(one, answers);
    if (unit !== null && unit !== most[0]) units[one.file] = unit;
  }
  return { metres_per_unit: most[0], ...(Object.keys(units).length > 0 ? { units } : {}) };
}
