import { useElementSize } from "@mantine/hooks";
import { useCallback, useEffect, useRef, useState, type RefCallback, type RefObject } from "react";
import { createStage, type Stage } from "./stage";

export interface StageParts {
  /** For the element that the view fills. */
  readonly holder: RefCallback<HTMLElement>;
  readonly canvas: RefCallback<HTMLCanvasElement>;
  readonly element: RefObject<HTMLElement | null>;
  /** Null until there is one. */
  readonly stage: Stage | null;
  /** Why there is none: a browser without WebGL. */
  readonly failure: string | null;
}

/** A 3D view for as long as the component is there. `drawn` says what the next drawing shows; the element's `data-drawn` says what is drawn. */
export function useStage(drawn?: RefObject<string>): StageParts {
  const [stage, setStage] = useState<Stage | null>(null);
  const [failure, setFailure] = useState<string | null>(null);
  const { ref, width, height } = useElementSize();
  const element = useRef<HTMLElement | null>(null);
  const current = useRef<Stage | null>(null);

  const holder = useCallback(
    (found: HTMLElement | null) => {
      element.current = found;
      ref(found);
    },
    [ref],
  );
  const canvas = useCallback(
    (found: HTMLCanvasElement | null) => {
      current.current?.stop();
      current.current = null;
      if (!found) return setStage(null);
      try {
        current.current = createStage(found, () => {
          if (element.current && drawn) element.current.dataset["drawn"] = drawn.current;
        });
        setStage(current.current);
      } catch {
        setFailure("This browser cannot draw 3D (WebGL is off or missing). Turn on hardware or software rendering in its settings, or use another one.");
      }
    },
    [drawn],
  );

  useEffect(() => {
    if (stage && width > 0 && height > 0) stage.resize(width, height);
  }, [stage, width, height]);

  return { holder, canvas, element, stage, failure };
}
