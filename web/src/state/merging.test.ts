import { expect, test } from "vitest";
import type { Recording } from "../api/types";
import { emptyPose, keyText, withJoint, type KeptPoint } from "../model/pose";
import { createKeyFrames } from "./keyFrames";
import { startMerging, type Label } from "./merging";
import { createSaveQueue, type Outcome } from "./saveQueue";
import { openSession } from "./session";

const PLACE = { camera: "cam0", frame: 3, hand: "right" as const };
const KEY = keyText(PLACE);
const pose = (x: number) => withJoint(emptyPose(), 0, { x, y: 1, v: 2 });
const label = (x: number | null, revision: number, more: Partial<Label> = {}): Label => ({
  ...PLACE,
  points: x === null ? null : pose(x).map(({ x: at, y, v }) => [at, y, v]),
  sources: null,
  revision,
  author: "Bob",
  ...more,
});
const settled = () => new Promise((resolve) => setTimeout(resolve, 5));
const journal = () => ({ load: () => new Map(), keep: () => true });

/** An open recording whose saves are answered when the test says so. */
function anOpenRecording() {
  const sent: { points: KeptPoint[] | null; base: number | null; answer: (outcome: Outcome) => void }[] = [];
  const queue = createSaveQueue((_, { points, base }) => new Promise((answer) => sent.push({ points, base, answer })), journal());
  queue.learn(new Map());
  const keys = createSaveQueue(() => Promise.resolve({ kind: "saved", revision: null }), journal());
  const recording = { cameras: [{ id: "cam0" }], frame_count: 10 } as unknown as Recording;
  const session = openSession(recording, [], queue, { camera: "cam0", frame: 3, hand: "right" }, createKeyFrames([], keys, () => undefined));
  const merging = startMerging(session.store, queue);
  const at = () => session.store.get().poses[KEY]?.[0]?.x;
  const act = (x: number) => session.store.set({ ...session.store.get(), poses: { ...session.store.get().poses, [KEY]: pose(x) } }, "person");
  return { session, queue, merging, sent, at, act };
}

test("what others save and delete is shown, the place stays, and nothing of it is saved or undone here", () => {
  const { session, merging, sent, at } = anOpenRecording();
  session.store.set({ ...session.store.get(), joint: 7 }, "person");
  merging.hear(label(5, 1));
  expect(at()).toBe(5);
  merging.hear(label(9, 1));
  expect(at(), "the same version once more is no news").toBe(5);
  merging.hear(label(null, 2));
  expect(at()).toBeUndefined();
  merging.hear(label(5, 1));
  expect(at(), "an older one neither").toBeUndefined();
  expect(session.store.get()).toMatchObject({ camera: "cam0", frame: 3, hand: "right", joint: 7 });
  expect(session.undo.canUndo()).toBe(false);
  expect(sent).toEqual([]);
});

test("undo does not bring back what was there before somebody else changed it", async () => {
  const { session, merging, sent, at, act } = anOpenRecording();
  act(1);
  act(2);
  sent[0]?.answer({ kind: "saved", revision: 1 });
  await settled();
  sent[1]?.answer({ kind: "saved", revision: 2 });
  await settled();
  merging.hear(label(50, 3));
  expect(at()).toBe(50);
  expect(session.undo.canUndo()).toBe(false);
});

test("what the next gesture changes is what somebody else saved", async () => {
  const { merging, sent, act } = anOpenRecording();
  merging.hear(label(5, 4));
  act(6);
  await settled();
  expect(sent[0]?.base).toBe(4);
});

test("a hand of which something waits stays; another's version then runs into the conflict, and its newest one is shown there", async () => {
  const { queue, merging, sent, at, act } = anOpenRecording();
  act(1);
  merging.hear(label(50, 1));
  expect(at()).toBe(1);
  sent[0]?.answer({ kind: "conflict", theirs: { points: [[50, 1, 2]], revision: 1 } });
  await settled();
  expect(at()).toBe(1);
  merging.hear(label(60, 2));
  expect(queue.status().conflicts.get(KEY)).toMatchObject({ revision: 2, author: "Bob" });
  queue.settle(KEY, "theirs");
  expect(queue.status().waiting).toBe(0);
});

test("what was saved on top of one's own save is shown as soon as that is acknowledged", async () => {
  const { merging, sent, at, act } = anOpenRecording();
  act(1);
  merging.hear(label(50, 2));
  expect(at()).toBe(1);
  sent[0]?.answer({ kind: "saved", revision: 1 });
  await settled();
  expect(at()).toBe(50);
});

test("one's own deletion is not undone by an older version on its way", async () => {
  const { session, merging, sent, at } = anOpenRecording();
  merging.hear(label(5, 1));
  session.store.set({ ...session.store.get(), poses: {} }, "person");
  sent[0]?.answer({ kind: "saved", revision: null, version: 2 });
  await settled();
  merging.hear(label(5, 1));
  expect(at()).toBeUndefined();
});

test("a drag goes on; when it ends, it is saved on what was there when it began", async () => {
  const { session, merging, sent, at } = anOpenRecording();
  merging.hear(label(5, 1));
  session.store.set({ ...session.store.get(), draft: pose(6) }, "person");
  expect(session.saving().waiting, "what is in hand is not saved").toBe(1);
  merging.hear(label(50, 2));
  expect(session.store.get().draft?.[0]?.x).toBe(6);
  expect(at()).toBe(5);
  session.store.set({ ...session.store.get(), draft: null, poses: { [KEY]: pose(7) } }, "person");
  await settled();
  expect(sent[0]?.base).toBe(1);
  expect(at()).toBe(7);
});

test("a drag that is called off shows what came meanwhile", () => {
  const { session, merging, at } = anOpenRecording();
  merging.hear(label(5, 1));
  session.store.set({ ...session.store.get(), draft: pose(6) }, "person");
  merging.hear(label(50, 2));
  session.store.set({ ...session.store.get(), draft: null }, "person");
  expect(at()).toBe(50);
});

test("loaded anew, what is hidden by now is gone, and what waits is not", async () => {
  const { session, merging, act } = anOpenRecording();
  merging.hear(label(5, 1, { frame: 1 }));
  act(1);
  merging.reload([label(8, 1, { frame: 2 })]);
  await settled();
  expect(Object.keys(session.store.get().poses).sort()).toEqual([keyText({ ...PLACE, frame: 2 }), KEY]);
  merging.reload([label(5, 1, { frame: 1 })]);
  expect(session.store.get().poses[keyText({ ...PLACE, frame: 1 })]?.[0]?.x, "and comes back").toBe(5);
});
