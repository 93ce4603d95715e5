import { Text } from "@mantine/core";
import { Link } from "react-router";
import { trackStyle } from "../../model/trackStyle";
import classes from "./Evaluations.module.css";

/** The line that stands for a track in the curves. */
export function TrackSwatch({ place }: { place: number }) {
  const { color, dash } = trackStyle(place);
  return (
    <svg width="24" height="8" aria-hidden style={{ flexShrink: 0 }}>
      <line x1="0" y1="4" x2="24" y2="4" stroke={color} strokeWidth="2.5" strokeDasharray={dash?.join(" ")} />
    </svg>
  );
}

interface TrackNameProps {
  place: number;
  track: { key: string; name: string; recording: string; recording_key: string };
}

export function TrackName({ place, track }: TrackNameProps) {
  return (
    <div style={{ display: "flex", alignItems: "center", gap: 8, minWidth: 0 }}>
      <TrackSwatch place={place} />
      <div style={{ minWidth: 0 }}>
        <Text size="sm" className="one-line">
          <Link to={`/tracks/${track.key}`} className={classes.link}>
            {track.name}
          </Link>
        </Text>
        <Text size="xs" className="quiet one-line" title={track.recording}>
          {track.recording}
        </Text>
      </div>
    </div>
  );
}
