import { expect, test } from "vitest";
import { createUpload, UNSENT, type Upload } from "./upload";

interface Word extends Upload<string> {
  readonly word: string;
}

const chosen: Word = { word: "hand", ...UNSENT };

/** A request that ends when it is told to, or is stopped. */
function hold(): { act: (word: Word, tell: unknown, signal: AbortSignal) => Promise<Partial<Word>>; answer: (result: string) => void; refuse: (failure: unknown) => void; signal: () => AbortSignal | undefined } {
  let settle: { answer: (part: Partial<Word>) => void; refuse: (failure: unknown) => void } | undefined;
  let given: AbortSignal | undefined;
  return {
    act: (_, __, signal) =>
      new Promise((answer, refuse) => {
        given = signal;
        settle = { answer, refuse };
        signal.addEventListener("abort", () => refuse(new DOMException("Stopped", "AbortError")));
      }),
    answer: (result) => settle?.answer({ result, sent: 1 }),
    refuse: (failure) => settle?.refuse(failure),
    signal: () => given,
  };
}

test("what was chosen is sent, and its result stays until it is ended", async () => {
  const upload = createUpload<Word, null>(null);
  upload.choose(chosen);
  const request = hold();
  const done = upload.work({ sent: 0 }, request.act);
  expect(upload.get()?.sent).toBe(0);
  request.answer("stored");
  await done;
  expect(upload.get()).toEqual({ word: "hand", sent: 1, failure: null, result: "stored" });
  upload.end();
  expect(upload.get()).toBeNull();
});

test("a failure is told and what was chosen stays chosen", async () => {
  const upload = createUpload<Word, null>(null);
  upload.choose(chosen);
  const request = hold();
  const done = upload.work({ sent: 0 }, request.act);
  request.refuse(new Error("The disk is full."));
  await done;
  expect(upload.get()).toMatchObject({ word: "hand", sent: null, result: null, failure: { message: "The disk is full." } });
});

test("a newer request stops the older one, of which nothing is heard any more", async () => {
  const upload = createUpload<Word, null>(null);
  upload.choose(chosen);
  const [first, second] = [hold(), hold()];
  const older = upload.work({ sent: 0 }, first.act);
  const newer = upload.work({ sent: 0 }, second.act);
  expect(first.signal()?.aborted).toBe(true);
  second.answer("the second");
  await Promise.all([older, newer]);
  expect(upload.get()).toMatchObject({ result: "the second", failure: null });
});

test("an end while it is sent leaves nothing behind", async () => {
  const upload = createUpload<Word, null>(null);
  upload.choose(chosen);
  const request = hold();
  const done = upload.work({ sent: 0 }, request.act);
  upload.end();
  await done;
  expect(upload.get()).toBeNull();
});
