/** Every key of the app: one table drives the handlers, the help overlay and the conflict check. */

export type Scope = "everywhere" | "annotate" | "track" | "curate" | "scan" | "moving";

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

/** A hand in 3D answers the same keys on every page that shows one. */
const handKeys = (scope: "curate" | "scan", group: string): KeyBinding[] =>
  table(scope, group, [
    [`${scope}.errors`, "Error colours on or off", "E"],
    [`${scope}.wireframe`, "Wireframe on or off", "W"],
    [`${scope}.layers`, "Scan, mesh, or both", "Tab"],
    [`${scope}.correspondences`, "Lines from the scan to the mesh on or off", "C"],
    [`${scope}.turntable`, "Turntable on or off", "V"],
    [`${scope}.palm`, "From the palm's side, the whole hand", "P", "Home"],
    [`${scope}.back`, "From the back of the hand", "B"],
    [`${scope}.thumb`, "From the thumb's side", "T"],
    [`${scope}.little`, "From the little finger's side", "L"],
    [`${scope}.turnLeft`, "Turn left", "Shift+Left"],
    [`${scope}.turnRight`, "Turn right", "Shift+Right"],
    [`${scope}.turnUp`, "Turn up", "Shift+Up"],
    [`${scope}.turnDown`, "Turn down", "Shift+Down"],
    [`${scope}.nearer`, "Nearer", "+", "="],
    [`${scope}.farther`, "Farther", "-"],
    [`${scope}.leave`, "Move the focus from the picture to the tools", "Esc"],
  ]);

export const KEYMAP = [
  ...table("everywhere", "Everywhere", [
    ["search", "Search recordings and pages", "Ctrl+K"],
    ["help", "This keyboard map", "F1", "?"],
    ["settings", "Settings: other keys", "F2"],
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
    ["hand.outside", "The rest of the hand is outside the image", "Shift+O"],
    ["joint.clear", "Clear the joint", "X", "Delete", "Backspace"],
    ["hand.clear", "Clear the whole hand", "Shift+Delete"],
    ["hand.switch", "Other hand", "G"],
    ["hand.bring", "Bring the pose of the last annotated frame", "B"],
    ["hand.propagate", "Copy the pose to the next frame and go there", "Ctrl+B"],
    ["hand.swap", "Swap left and right", "Alt+T"],
    ["key.mark", "Set or remove a key frame of this hand", "K"],
    ["key.accept", "Accept what is between this key frame and the next", "Shift+K"],
    ["place.mode", "After a click: next joint, same joint in the next frame, or stay", "M"],
    ["suggestion.joint", "Accept what is suggested for the joint", "A"],
    ["suggestion.hand", "Accept what is suggested for the hand", "Shift+A"],
    ["suggestion.toggle", "Hide or show suggestions", "Shift+U"],
    ["flag.next", "Next label that looks wrong", "N"],
    ["flag.previous", "Previous label that looks wrong", "Shift+N"],
    ["flag.dismiss", "The label is right: dismiss the flag", "Shift+I"],
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
    ["drag.cancel", "Cancel a drag; without one: move the focus from the picture to the tools", "Esc"],
    ["save.now", "Save everything now", "Ctrl+S"],
  ]),
  ...table("annotate", "Several cameras", [
    ["views.triangulate", "Triangulate what is marked in two cameras, and suggest it in the others", "T"],
    ["suggestion.frame", "Accept all suggestions in this frame", "Shift+T"],
    ["views.epipolar", "Epipolar lines on or off", "Y"],
    ["views.look", "Look at the joint in every picture, then at the hand, then at all", "L"],
    ["views.large", "Enlarge this camera's picture, or restore it", "P"],
    ["views.worst", "Mark that is farthest off; again: the next one", "Shift+L"],
  ]),
  ...table("annotate", "Assignment", [
    ["assignment.next", "Next frame to do", "Alt+N"],
    ["assignment.submit", "Submit the work", "Ctrl+Enter"],
    ["assignment.comment", "Comment on this joint", "Alt+C"],
    ["assignment.accept", "Accept submitted work", "Alt+A"],
    ["assignment.return", "Return it with the reason", "Alt+R"],
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
  ...table("curate", "Curation", [
    ["curate.accept", "Accept, and go on", "A"],
    ["curate.reject", "Reject without a reason, and go on", "R"],
    ["curate.unsure", "Unsure, and go on", "U"],
    ["curate.undo", "Undo the last decision", "Z", "Backspace"],
    ["curate.next", "Next registration", "Right", "Space"],
    ["curate.previous", "Previous registration", "Left", "Shift+Space"],
    ...Array.from({ length: 9 }, (_, at): [string, string, string] => [`curate.reason${at + 1}`, `Reject for reason ${at + 1} of the list, and go on`, String(at + 1)]),
    ["curate.save", "Save everything now", "Ctrl+S"],
  ]),
  ...handKeys("curate", "Hand while curating"),
  ...table("scan", "Scan", [
    ["scan.cut", "Knife: the next stroke cuts; again: turn the view instead", "X"],
    ["scan.flip", "Take the other side of the last line", "F"],
    ["scan.uncut", "Undo the last stroke", "Z", "Backspace"],
    ["scan.save", "Save the crop", "Ctrl+S"],
    ["scan.next", "Next scan", "Right"],
    ["scan.previous", "Previous scan", "Left"],
  ]),
  ...handKeys("scan", "Hand of a scan"),
  ...table("moving", "Moving scan", [
    ["moving.play", "Play or pause", "Space"],
    ["moving.next", "Next frame", "F", "Right"],
    ["moving.previous", "Previous frame", "D", "Left"],
    ["moving.forward", "10 frames on", "V"],
    ["moving.backward", "10 frames back", "C"],
    ["moving.first", "First frame", "Home"],
    ["moving.last", "Last frame", "End"],
    ["moving.nextDoubt", "Next frame that is not good", "N"],
    ["moving.previousDoubt", "Previous frame that is not good", "Shift+N"],
    ["moving.begin", "The stretch begins here", "I"],
    ["moving.end", "The stretch ends here", "O"],
    ["moving.accept", "Accept the stretch", "A"],
    ["moving.reject", "Reject the stretch", "R"],
    ["moving.undo", "Undo your last decision", "Z", "Backspace"],
    ["moving.rerun", "Register again from here with another prior", "G"],
    ["moving.errors", "Error colours on or off", "E"],
    ["moving.wireframe", "Wireframe on or off", "W"],
    ["moving.layers", "Scan, body, or both", "Tab"],
    ["moving.turntable", "Turntable on or off", "T"],
    ["moving.whole", "The whole person, from the side they are first seen from", "P"],
    ["moving.behind", "The whole person from behind", "B"],
    ["moving.turnLeft", "Turn left", "Shift+Left"],
    ["moving.turnRight", "Turn right", "Shift+Right"],
    ["moving.turnUp", "Turn up", "Shift+Up"],
    ["moving.turnDown", "Turn down", "Shift+Down"],
    ["moving.nearer", "Nearer", "+", "="],
    ["moving.farther", "Farther", "-"],
    ["moving.leave", "Move the focus from the picture to the tools", "Esc"],
  ]),
] as const satisfies readonly KeyBinding[];

/** Keys that the browser or the system keeps for itself. */
export const RESERVED: readonly string[] = [
  ...["Ctrl+T", "Ctrl+W", "Ctrl+N", "Ctrl+Tab", "Ctrl+Shift+Tab", "Alt+Tab", "Ctrl+Shift+T", "Ctrl+Shift+N", "Ctrl+Shift+W", "Alt+Left", "Alt+Right"],
  ...["Ctrl+L", "Ctrl+R", "Ctrl+Shift+R", "Ctrl+Q", "Ctrl+PageUp", "Ctrl+PageDown", "Alt+F4", "F5", "F11", "F12"],
];

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

/** Keys that a person has put elsewhere, by the id of the binding. */
export type Remap = Readonly<Record<string, readonly string[]>>;

const meet = (a: KeyBinding, b: KeyBinding): boolean => a.scope === b.scope || a.scope === "everywhere" || b.scope === "everywhere";

/**
 * The table with a person's own keys in it. A key that a person gave to one thing is taken from whatever has it by
 * default, so a new version's new keys never bring a conflict; unknown ids and reserved keys are left out.
 */
export function withRemap(map: readonly KeyBinding[], remap: Remap): readonly KeyBinding[] {
  const chosen = map.map((binding) => {
    const keys: unknown = remap[binding.id];
    return Array.isArray(keys) ? { ...binding, keys: keys.filter((key: unknown): key is string => typeof key === "string" && !RESERVED.includes(key)) } : binding;
  });
  const own = chosen.filter((binding, index) => binding !== map[index]);
  return chosen.map((binding, index) =>
    binding === map[index] ? { ...binding, keys: binding.keys.filter((key) => !own.some((other) => meet(binding, other) && other.keys.includes(key))) } : binding,
  );
}

/** What a person asked for, put into words of the table: only what differs from the defaults is kept. */
export function remapOf(map: readonly KeyBinding[], defaults: readonly KeyBinding[] = KEYMAP): Remap {
  const own = map.filter((binding) => binding.keys.join(" ") !== defaults.find((one) => one.id === binding.id)?.keys.join(" "));
  return Object.fromEntries(own.map((binding) => [binding.id, binding.keys]));
}

/** Why a key cannot be given to a binding: the browser keeps it, it does nothing alone, or something else has it. */
export type KeyFault = { readonly kind: "reserved" } | { readonly kind: "modifier" } | { readonly kind: "taken"; readonly by: KeyBinding };

const MODIFIERS = new Set(["Control", "Alt", "Shift", "Meta", "AltGraph", "CapsLock", "Dead", "Unidentified", "Process"]);

export function faultOf(map: readonly KeyBinding[], id: string, chord: string): KeyFault | null {
  const binding = map.find((one) => one.id === id);
  if (MODIFIERS.has(chord.split(/\+(?=.)/).at(-1) ?? "")) return { kind: "modifier" };
  if (RESERVED.includes(chord)) return { kind: "reserved" };
  const by = map.find((other) => other.id !== id && binding && meet(binding, other) && other.keys.includes(chord));
  return by ? { kind: "taken", by } : null;
}

/** Chord to binding for one page; what the page binds goes before what is bound everywhere. */
export function bindingsFor(scope: Scope, map: readonly KeyBinding[] = KEYMAP): ReadonlyMap<string, KeyBinding> {
  const found = new Map<string, KeyBinding>();
  for (const wanted of ["everywhere", scope] as const) {
    for (const binding of map) {
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
      a.keys.filter((key) => meet(a, b) && b.keys.includes(key)).forEach((key) => conflicts.push(`${key}: ${a.id}, ${b.id}`));
    }),
  );
  return conflicts;
}
