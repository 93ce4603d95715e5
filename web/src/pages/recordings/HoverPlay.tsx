import { useEffect, useState } from "react";
import { IconPhotoOff } from "@tabler/icons-react";
import type { Recording } from "../../api/types";
import { thumbnailUrl } from "../../api/recordings";
import classes from "./HoverPlay.module.css";

const STEPS = 12;
const STEP_MS = 140;

/** A recording's picture; it plays, in few steps, while the pointer or the focus is on its card. */
export function HoverPlay({ recording, isPlaying }: { recording: Recording; isPlaying: boolean }) {
  const camera = recording.cameras[0]?.id;
  const [step, setStep] = useState(0);
  const [isBroken, setBroken] = useState(false);
  const [isCutOff, setCutOff] = useState(false);
  useEffect(() => setCutOff(false), [isPlaying]);
  useEffect(() => {
    // Where a picture does not come, the others are not asked for either, again and again.
    if (!isPlaying || isCutOff) {
      setStep(0);
      return;
    }
    const timer = setInterval(() => setStep((now) => (now + 1) % STEPS), STEP_MS);
    return () => clearInterval(timer);
  }, [isPlaying, isCutOff]);

  const frameOf = (at: number): number => Math.min(recording.frame_count - 1, Math.floor((at * recording.frame_count) / STEPS));
  if (!camera || isBroken) {
    return (
      <div className={classes.box}>
        <IconPhotoOff size={32} stroke={1.25} className="quiet" aria-label="No picture" />
      </div>
    );
  }
  return (
    <div className={classes.box}>
      <img src={thumbnailUrl(recording, camera, frameOf(step))} alt="" className={classes.image} onError={() => (step === 0 ? setBroken(true) : setCutOff(true))} />
      {isPlaying && <div className={classes.bar} style={{ transform: `scaleX(${(step + 1) / STEPS})` }} />}
    </div>
  );
}
