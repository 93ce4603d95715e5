import { expect, test } from "vitest";
import { createKeyFrames } from "./keyFrames";
import { createSaveQueue, type Outcome } from "./saveQueue";

const settled = () => new Promise((resolve) => setTimeout(resolve, 5));

function keyFrames(answer: () => Promise<Outcome>) {
  const refused: string[] = [];
  const queue = createSaveQueue(answer, { load: () => new Map(), keep: () => true });
  return { keys: createKeyFrames(["1|right|cam0"], queue, (reason) => refused.push(reason)), refused };
}

test("a key frame waits like a gesture until the server has it, and what others do is shown around it", async () => {
  let acknowledge: (outcome: Outcome) => void = () => undefined;
  const { keys } = keyFrames(() => new Promise((resolve) => (acknowledge = resolve)));
  keys.toggle("2|right|cam0");
  keys.toggle("1|right|cam0");
  expect(keys.queue.status().waiting).toBe(2);
  keys.learn(["1|right|cam0", "3|right|cam0"]);
  expect([...keys.store.get()].sort()).toEqual(["2|right|cam0", "3|right|cam0"]);
  acknowledge({ kind: "saved", revision: null });
  await settled();
  expect(keys.queue.status().waiting).toBe(1);
});

test("what the server refuses is taken back and said", async () => {
  const { keys, refused } = keyFrames(() => Promise.resolve({ kind: "refused", reason: "It was submitted." }));
  keys.toggle("2|right|cam0");
  keys.toggle("1|right|cam0");
  await settled();
  expect([...keys.store.get()]).toEqual(["1|right|cam0"]);
  expect(refused).toEqual(["It was submitted.", "It was submitted."]);
  expect(keys.queue.status().waiting).toBe(0);
});
