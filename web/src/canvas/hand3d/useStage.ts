import { useElementSize, useMergedRef } from "@mantine/hooks";
import { useCallback, useEffect, useRef, useState, type RefCallback } from "react";
import { createStage, type Stage } from "./stage";

interface StageParts {
  /** For the element that the view fills. */
  readonly holder: RefCallback<HTMLElement>;
  readonly canvas: RefCallback<HTMLCanvasElement>;
  /** Null until there is one. */
  readonly stage: Stage | null;
  /** Why there is none: a browser without WebGL. */
  readonly failure: string | null;
}

/** A 3D view for as long as the component is there. `onDrawn` is called after every drawing. */
export function useStage(onDrawn: () => void): StageParts {
  const [stage, setStage] = useState<Stage | null>(null);
  const [failure, setFailure] = useState<string | null>(null);
  const drawn = useRef(onDrawn);
  drawn.current = onDrawn;
  const { ref, width, height } = useElementSize();
  const holder = useMergedRef<HTMLElement>(ref as RefCallback<HTMLElement>);
  const current = useRef<Stage | null>(null);

  const canvas = useCallback((element: HTMLCanvasElement | null) => {
    current.current?.stop();
    current.current = null;
    if (!element) return setStage(null);
    try {
      current.current = createStage(element, () => drawn.current());
      setStage(current.current);
    } catch {
      setFailure("This browser draws no 3D (WebGL is off or missing). Turn on hardware or software rendering in its settings, or use another one.");
    }
  }, []);

  useEffect(() => {
    if (stage && width > 0 && height > 0) stage.resize(width, height);
  }, [stage, width, height]);

  return { holder, canvas, stage, failure };
}
