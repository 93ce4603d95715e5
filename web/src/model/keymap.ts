/** Every key of the app: one table drives the handlers, the help overlay and the conflict check. */

export type Scope = "everywhere" | "annotate" | "track";

export interface KeyBinding {
  readonly id: string;
  readonly scope: Scope;
  readonly group: string;
  /** As `chordOf` writes them: modifiers in the order Ctrl Alt Shift, then the key. */
  readonly keys: readonly string[];
  readonly label: string;
}

const table = (scope: Scope, group: string, rows: readonly (readonly [string, string, ...string[]])[]): KeyBinding[] =>
  rows.map(([id, label, ...keys]) => ({ id, scope, group, label, keys }));

export const KEYMAP = [
  ...table("everywhere", "Everywhere", [
    ["search", "Search recordings and pages", "Ctrl+K"],
    ["help", "This keyboard map", "F1", "?"],
    ["undo", "Undo", "Ctrl+Z"],
    ["redo", "Redo", "Ctrl+Shift+Z", "Ctrl+Y"],
  ]),
  ...table("annotate", "Frames", [
    ["frame.next", "Next frame", "F", "Right"],
    ["frame.previous", "Previous frame", "D", "Left"],
    ["frame.forward", "10 frames on", "V"],
    ["frame.back", "10 frames back", "C"],
    ["frame.nextAnnotated", "Next annotated frame", "R"],
    ["frame.previousAnnotated", "Previous annotated frame", "E"],
    ["frame.goto", "Go to a frame by number", "`", "Ctrl+J"],
    ["camera.next", "Next camera", "]"],
    ["camera.previous", "Previous camera", "["],
    ["play", "Play or pause", "Space"],
  ]),
  ...table("annotate", "Joints", [
    ["joint.next", "Next joint", "Tab", "S", "Down"],
    ["joint.previous", "Previous joint", "Shift+Tab", "W", "Up"],
    ["finger.wrist", "Wrist", "0"],
    ["finger.thumb", "Thumb (again: along the finger)", "1"],
    ["finger.index", "Index finger", "2"],
    ["finger.middle", "Middle finger", "3"],
    ["finger.ring", "Ring finger", "4"],
    ["finger.little", "Little finger", "5"],
    ["joint.place", "Place the joint beside its neighbour, then move it with Shift and arrows", "Enter"],
    ["joint.occluded", "Occluded, or visible again", "Q"],
    ["joint.outside", "Outside the image, or back", "O"],
    ["joint.clear", "Clear the joint", "X", "Delete", "Backspace"],
    ["hand.clear", "Clear the whole hand", "Shift+Delete"],
    ["hand.switch", "Other hand", "G"],
    ["hand.bring", "Bring the pose of the last annotated frame", "B"],
    ["nudge.left", "Move the joint half a pixel left", "Shift+Left"],
    ["nudge.right", "Move the joint half a pixel right", "Shift+Right"],
    ["nudge.up", "Move the joint half a pixel up", "Shift+Up"],
    ["nudge.down", "Move the joint half a pixel down", "Shift+Down"],
    ["push.left", "Move the joint 5 pixels left", "Alt+Shift+Left"],
    ["push.right", "Move the joint 5 pixels right", "Alt+Shift+Right"],
    ["push.up", "Move the joint 5 pixels up", "Alt+Shift+Up"],
    ["push.down", "Move the joint 5 pixels down", "Alt+Shift+Down"],
  ]),
  ...table("annotate", "Picture", [
    ["view.fit", "Fit the image", "Ctrl+="],
    ["view.magnifier", "Magnifier (hold)", "Z"],
    ["view.depth", "Next arrangement of colour and depth", "I"],
    ["view.hands", "Hide or show the hands", "H"],
    ["view.names", "Joint names on or off", "J"],
    ["view.brighter", "Brighter", "Ctrl+Up"],
    ["view.darker", "Darker", "Ctrl+Down"],
    ["view.contrastUp", "More contrast, or a nearer depth range", "Ctrl+Shift+Up"],
    ["view.contrastDown", "Less contrast, or a farther depth range", "Ctrl+Shift+Down"],
    ["drag.cancel", "Call off a drag; without one: leave the picture for the tools", "Esc"],
    ["save.now", "Send what waits at once", "Ctrl+S"],
  ]),
  ...table("track", "Track", [
    ["track.play", "Play or pause", "Space"],
    ["track.next", "Next frame", "F", "Right"],
    ["track.previous", "Previous frame", "D", "Left"],
    ["track.forward", "10 frames on", "V"],
    ["track.back", "10 frames back", "C"],
    ["track.nextBad", "Next lost frame, or the worst one when none is lost", "N"],
    ["track.previousBad", "Previous lost frame", "Shift+N"],
    ["track.first", "First frame", "Home"],
    ["track.last", "Last frame", "End"],
    ["track.annotate", "Annotate this frame", "A"],
    ["track.mesh", "Mesh overlay on the image", "M"],
    ["track.skeleton", "Skeleton overlay on the image", "S"],
  ]),
] as const satisfies readonly KeyBinding[];

/** Keys that the browser or the system keeps for itself. */
export const RESERVED = ["Ctrl+T", "Ctrl+W", "Ctrl+N", "Ctrl+Tab", "Alt+Tab", "Ctrl+Shift+T", "Ctrl+Shift+N", "Alt+Left", "Alt+Right"];

const NAMES: Record<string, string> = {
  ArrowLeft: "Left",
  ArrowRight: "Right",
  ArrowUp: "Up",
  ArrowDown: "Down",
  " ": "Space",
  Escape: "Esc",
};

export interface KeyPress {
  key: string;
  code?: string;
  ctrlKey: boolean;
  metaKey: boolean;
  altKey: boolean;
  shiftKey: boolean;
}

/** How a key press is written in the table. Command counts as Ctrl; Shift is dropped where it only makes the sign ("?"). */
export function chordOf(press: KeyPress): string {
  const named = NAMES[press.key] ?? press.key;
  const key = named.length === 1 ? named.toUpperCase() : named;
  const isSign = key.length === 1 && !/[A-Z0-9]/.test(key);
  const parts = [];
  if (press.ctrlKey || press.metaKey) parts.push("Ctrl");
  if (press.altKey) parts.push("Alt");
  if (press.shiftKey && !isSign) parts.push("Shift");
  return [...parts, key].join("+");
}

/** Chord to binding for one page; what the page binds goes before what is bound everywhere. */
export function bindingsFor(scope: Scope): ReadonlyMap<string, KeyBinding> {
  const found = new Map<string, KeyBinding>();
  for (const wanted of ["everywhere", scope] as const) {
    for (const binding of KEYMAP as readonly KeyBinding[]) {
      if (binding.scope === wanted) binding.keys.forEach((key) => found.set(key, binding));
    }
  }
  return found;
}

/** Two bindings that could both be meant by one key on some page. */
export function findConflicts(map: readonly KeyBinding[]): string[] {
  const conflicts: string[] = [];
  map.forEach((a, i) =>
    map.slice(i + 1).forEach((b) => {
      const meet = a.scope === b.scope || a.scope === "everywhere" || b.scope === "everywhere";
      a.keys.filter((key) => meet && b.keys.includes(key)).forEach((key) => conflicts.push(`${key}: ${a.id}, ${b.id}`));
    }),
  );
  return conflicts;
}

/** First key of an action, for hints beside buttons. */
export const keyOf = (id: string): string => (KEYMAP as readonly KeyBinding[]).find((binding) => binding.id === id)?.keys[0] ?? "";
