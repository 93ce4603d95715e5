import { HAND_LENGTH } from "../../model/scanUnit";
import { Thumbnail } from "../parts/Thumbnail";
import classes from "./HandForScale.module.css";

interface HandForScaleProps {
  /** Address of the scan's picture, upright. */
  picture: string;
  /** Length of a side of the picture, m. */
  pictureSide: number;
  /** Longest side of the scan, m. */
  length: number;
}

const HEIGHT_PX = 208;
/** Share of the picture that is empty below the scan (server/scans/thumbnails.py). */
const EMPTY = 0.06;

/** An adult's hand, 100 mm by 190 mm. */
function Hand({ height }: { height: number }) {
  return (
    <svg viewBox="0 0 100 190" height={height} width={(height * 100) / 190} className={classes.hand} aria-hidden>
      <rect x="14" y="86" width="72" height="104" rx="24" />
      <rect x="14" y="24" width="16" height="104" rx="8" />
      <rect x="33" y="6" width="17" height="112" rx="8.5" />
      <rect x="53" y="14" width="16" height="108" rx="8" />
      <rect x="72" y="42" width="14" height="88" rx="7" />
      <rect x="4" y="92" width="19" height="72" rx="9.5" transform="rotate(-24 14 160)" />
    </svg>
  );
}

/** A scan beside an adult's hand, both drawn to one scale. */
export function HandForScale({ picture, pictureSide, length }: HandForScaleProps) {
  const pixels = HEIGHT_PX / Math.max(HAND_LENGTH, pictureSide);
  const rule = pixels * 0.1;
  return (
    <figure className={classes.figure} aria-label={`The scan, ${(100 * length).toFixed(1)} cm long, beside an adult’s hand of ${100 * HAND_LENGTH} cm`}>
      <div className={classes.row} style={{ height: HEIGHT_PX }}>
        <div className={classes.one}>
          <Hand height={Math.max(2, pixels * HAND_LENGTH)} />
        </div>
        <div className={classes.one}>
          <Thumbnail src={picture} alt="" width={Math.max(2, pixels * pictureSide)} height={Math.max(2, pixels * pictureSide)} className={classes.picture} style={{ marginBottom: -EMPTY * pixels * pictureSide }} />
        </div>
      </div>
      <div className={classes.captions}>
        <span>Adult’s hand, {100 * HAND_LENGTH} cm</span>
        <span data-testid="scan-length">
          This scan, <b>{(100 * length).toFixed(1)} cm</b>
        </span>
      </div>
      <div className={classes.rule} aria-hidden>
        <span style={{ width: Math.max(1, rule) }} />
        10 cm
      </div>
    </figure>
  );
}
