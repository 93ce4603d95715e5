import { useQueryClient } from "@tanstack/react-query";
import { useCallback, useEffect, useRef, useState } from "react";
import { BLOCK, fetchBlock, peekBlock, type BodyMotion, type Population } from "../../api/bodies";

export interface OpenMotion {
  readonly id: string;
  readonly name: string;
  readonly motion: BodyMotion;
}

export interface MotionState {
  readonly frame: number;
  readonly isPlaying: boolean;
  /** Vertices of the frame, or of the last one that was there. */
  readonly vertices: Float32Array | undefined;
  readonly failure: Error | null;
  goTo: (frame: number) => void;
  play: (isOn: boolean) => void;
}

/** The frames of a motion, fetched in blocks a little ahead of what is shown; playing waits for them. */
export function useMotion(open: OpenMotion | null, population: Population): MotionState {
  const client = useQueryClient();
  const [frame, setFrame] = useState(0);
  const [isPlaying, setPlaying] = useState(false);
  const [vertices, setVertices] = useState<Float32Array>();
  const [failure, setFailure] = useState<Error | null>(null);
  const count = open?.motion.poses.length ?? 0;
  const place = useRef(0);
  const goTo = useCallback((next: number): void => {
    place.current = next;
    setFrame(next);
  }, []);

  useEffect(() => {
    goTo(0);
    setPlaying(false);
    setFailure(null);
  }, [open, goTo]);

  useEffect(() => {
    if (!open) return setVertices(undefined);
    let isWanted = true;
    const block = Math.floor(frame / BLOCK);
    const show = (data: Float32Array): void => {
      const size = data.length / Math.min(BLOCK, count - block * BLOCK);
      setVertices(data.subarray((frame % BLOCK) * size, (frame % BLOCK) * size + size));
    };
    const there = peekBlock(client, population, open.id, block);
    if (there) show(there);
    const fetched = fetchBlock(client, population, open.motion, open.id, block);
    fetched.then(
      (data) => {
        if (!isWanted) return;
        setFailure(null);
        if (!there) show(data);
        if ((block + 1) * BLOCK < count) void fetchBlock(client, population, open.motion, open.id, block + 1).catch(() => undefined);
      },
      (error: Error) => isWanted && setFailure(error),
    );
    return () => {
      isWanted = false;
    };
  }, [client, open, population, frame, count]);

  useEffect(() => {
    if (!isPlaying || !open) return;
    const { fps } = open.motion;
    let since = performance.now();
    let asked = 0;
    const step = (now: number): void => {
      const due = Math.floor(((now - since) * fps) / 1000);
      const next = (place.current + due) % count;
      if (due > 0 && peekBlock(client, population, open.id, Math.floor(next / BLOCK))) {
        since += (due * 1000) / fps;
        goTo(next);
      } else if (due > 0) {
        // The block is on its way: time stands still until it is there.
        since = now - 1000 / fps;
        void fetchBlock(client, population, open.motion, open.id, Math.floor(next / BLOCK)).catch((error: Error) => {
          setFailure(error);
          setPlaying(false);
        });
      }
      asked = requestAnimationFrame(step);
    };
    asked = requestAnimationFrame(step);
    return () => cancelAnimationFrame(asked);
  }, [client, isPlaying, open, population, count, goTo]);

  return { frame, isPlaying, vertices, failure, goTo, play: setPlaying };
}
