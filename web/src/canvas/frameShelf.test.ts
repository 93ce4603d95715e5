import { expect, it } from "vitest";
import { createFrameShelf } from "./frameShelf";

const settle = async (): Promise<void> => {
  for (let turn = 0; turn < 100; turn += 1) await Promise.resolve();
};

function makeShelf(failing: number[] = []) {
  const asked: number[] = [];
  const shelf = createFrameShelf(
    (frame) => {
      asked.push(frame);
      return failing.includes(frame) ? Promise.reject(new Error(`frame ${frame} is lost`)) : Promise.resolve(`picture ${frame}`);
    },
    Array.from({ length: 200 }, (_, at) => at).filter((frame) => frame !== 3),
  );
  return { shelf, asked };
}

it("fetches the wanted frame first and ten behind it, over a gap", async () => {
  const { shelf, asked } = makeShelf();
  shelf.want(1, 1);
  expect(asked).toEqual([1, 2, 4]);
  await settle();
  expect(asked).toEqual([1, 2, 4, 5, 6, 7, 8, 9, 10, 11, 12]);
  expect(shelf.get(4)).toBe("picture 4");
  expect(shelf.get(13)).toBeNull();
});

it("fetches only the frames that are played when some are left out", async () => {
  const { shelf, asked } = makeShelf();
  shelf.want(10, 2);
  await settle();
  expect(asked).toEqual([10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30]);
});

it("keeps a failure until somebody asks again, and goes on with the others", async () => {
  const failing = [11];
  const { shelf, asked } = makeShelf(failing);
  let told = 0;
  shelf.watch(() => (told += 1));
  shelf.want(10, 1);
  await settle();
  expect(shelf.failureOf(11)?.message).toBe("frame 11 is lost");
  expect([told, asked.length]).toEqual([11, 11]);
  failing.pop();
  shelf.retry();
  await settle();
  expect(shelf.get(11)).toBe("picture 11");
});

it("fetches again what somebody says is old", async () => {
  const { shelf, asked } = makeShelf();
  shelf.want(20, 1);
  await settle();
  shelf.forget((frame, held) => frame > 28 && held === `picture ${frame}`);
  expect(shelf.get(29)).toBeNull();
  await settle();
  expect(asked.slice(-2)).toEqual([29, 30]);
});

it("puts the farthest frames away and forgets everything when it stops", async () => {
  const { shelf } = makeShelf();
  for (let frame = 10; frame < 190; frame += 10) {
    shelf.want(frame, 1);
    await settle();
  }
  expect(shelf.get(10)).toBeNull();
  expect(shelf.get(185)).toBe("picture 185");
  shelf.stop();
  expect(shelf.get(185)).toBeNull();
});
