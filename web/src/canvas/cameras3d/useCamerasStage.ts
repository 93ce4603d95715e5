import { useElementSize } from "@mantine/hooks";
import { useCallback, useEffect, useRef, useState, type RefCallback } from "react";
import { createCamerasStage, type CamerasStage } from "./stage";

export interface CamerasStageParts {
  /** For the element that the view fills. */
  readonly holder: RefCallback<HTMLDivElement>;
  readonly canvas: RefCallback<HTMLCanvasElement>;
  readonly stage: CamerasStage | null;
  /** Why there is none: a browser without WebGL. */
  readonly failure: string | null;
}

/** A 3D view of cameras for as long as the component is there. */
export function useCamerasStage(): CamerasStageParts {
  const [stage, setStage] = useState<CamerasStage | null>(null);
  const [failure, setFailure] = useState<string | null>(null);
  const { ref: holder, width, height } = useElementSize<HTMLDivElement>();
  const current = useRef<CamerasStage | null>(null);
  const canvas = useCallback((found: HTMLCanvasElement | null) => {
    current.current?.stop();
    current.current = null;
    if (!found) return setStage(null);
    try {
      current.current = createCamerasStage(found);
      setStage(current.current);
    } catch {
      setFailure("This browser cannot draw 3D (WebGL is off or missing). Turn on hardware or software rendering in its settings, or use another one.");
    }
  }, []);
  useEffect(() => {
    if (stage && width > 0 && height > 0) stage.resize(width, height);
  }, [stage, width, height]);
  return { holder, canvas, stage, failure };
}
