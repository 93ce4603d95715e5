import { SegmentedControl, useComputedColorScheme } from "@mantine/core";
import { useCallback, useMemo, useRef, useState } from "react";
import { useNavigate, useSearchParams } from "react-router";
import { useKeymap } from "../../actions/useKeymap";
import { LAYERS, useViewer, type Layer, type Shown } from "../../api/tracks";
import type { Recording, Track, TrackFrames } from "../../api/types";
import { FrameStrip } from "../../canvas/FrameStrip";
import { badFrames, nextIn } from "../../model/badFrames";
import { frameError } from "../../model/frameError";
import { formatMeasure } from "../../model/format";
import { trackRows } from "../../model/trackRows";
import { usePlayback } from "../parts/usePlayback";
import { useLateAddress } from "../parts/useLateAddress";
import { useIsCompact } from "../parts/useScreen";
import { ErrorLegend } from "./ErrorLegend";
import { TrackBar } from "./TrackBar";
import { TrackPictures, type Overlays } from "./TrackPictures";
import { TrackPlots } from "./TrackPlots";
import classes from "./TrackReview.module.css";
import { ViewerFrame } from "./ViewerFrame";

/** In the address in place of a camera's id. */
const ALL = "*";

type ShownLayers = Record<Layer, boolean>;

/** Layers as the address names them; cloud and mesh when it names none. */
const readLayers = (named: string | null): ShownLayers => {
  const on = (named ?? "cloud,mesh").split(",");
  return Object.fromEntries(LAYERS.map((layer) => [layer, on.includes(layer)])) as ShownLayers;
};

interface TrackReviewProps {
  track: Track;
  frames: TrackFrames;
  recording: Recording;
}

/** One frame drives everything: the 3D viewer, the image with the overlay, the curves and the timeline. */
export function TrackReview({ track, frames, recording }: TrackReviewProps) {
  const [address] = useSearchParams();
  const navigate = useNavigate();
  const first = frames.frame[0] ?? 0;
  const last = frames.frame.at(-1) ?? first;
  const clamp = useCallback((frame: number) => Math.min(last, Math.max(first, frame)), [first, last]);
  const [frame, setFrame] = useState(() => clamp(Number(address.get("frame") ?? first) || first));
  const [cameraId, setCameraId] = useState(() => address.get("camera") ?? recording.cameras[0]?.id ?? "");
  const [tab, setTab] = useState(() => ["cameras", "energy", "timing"].find((name) => name === address.get("tab")) ?? (frames.views.length > 0 ? "cameras" : "error"));
  const isAll = cameraId === ALL && recording.cameras.length > 1;
  const camera = recording.cameras.find((one) => one.id === cameraId) ?? recording.cameras[0];
  const cameras = isAll ? recording.cameras : recording.cameras.filter((one) => one === camera);
  const [layers, setLayers] = useState<ShownLayers>(() => readLayers(address.get("layers")));
  const [terms, setTerms] = useState<Record<string, boolean>>({});
  const [overlays, setOverlays] = useState<Overlays>(() => ({ mesh: true, skeleton: true, unknown: readLayers(address.get("layers")).unknown }));
  // A small screen shows one at a time; the 3D view is opened when somebody wants it, and stays.
  const isCompact = useIsCompact();
  const [shown, setShown] = useState<"image" | "space">("image");
  const hasSpace = useRef(false);
  hasSpace.current ||= shown === "space";
  const dark = useComputedColorScheme("dark") === "dark";
  const show = useMemo<Shown>(() => ({ ...layers, correspondences: layers.correspondences && (Object.keys(terms).length > 0 ? terms : true), dark }), [layers, terms, dark]);
  const viewer = useViewer(track.id, frame, show);
  const seek = useCallback((to: number) => setFrame(clamp(to)), [clamp]);

  const readyPictures = useRef<Record<string, boolean>>({});
  const [isPlaying, setPlaying] = useState(false);
  usePlayback(isPlaying, recording.fps, {
    isReady: () => cameras.every(({ id }) => readyPictures.current[id] !== false),
    step: () => {
      setFrame((now) => clamp(now + 1));
      return frame + 1 < last;
    },
    end: () => setPlaying(false),
  });

  useLateAddress({ frame: String(frame), camera: isAll ? ALL : (camera?.id ?? ""), tab, layers: LAYERS.filter((layer) => layers[layer]).join(",") }, 150);

  const error = useMemo(() => frameError(frames), [frames]);
  const bad = useMemo(() => badFrames(frames), [frames]);
  const lost = useMemo(() => frames.frame.filter((_, index) => frames.status[index] === "lost"), [frames]);
  const rows = useMemo(() => trackRows(frames, recording.frame_count), [frames, recording.frame_count]);
  const toBad = (direction: 1 | -1): void => seek(nextIn(bad, frame, direction) ?? frame);
  const annotate = (): void => void navigate(`/recordings/${recording.id}/annotate?camera=${encodeURIComponent(camera?.id ?? "")}&frame=${frame}`);
  const play = (): void => {
    if (!isPlaying && frame >= last) setFrame(first);
    setPlaying(!isPlaying);
  };

  useKeymap("track", {
    "track.play": play,
    "track.next": () => seek(frame + 1),
    "track.previous": () => seek(frame - 1),
    "track.forward": () => seek(frame + 10),
    "track.back": () => seek(frame - 10),
    "track.nextBad": () => toBad(1),
    "track.previousBad": () => toBad(-1),
    "track.first": () => seek(first),
    "track.last": () => seek(last),
    "track.annotate": annotate,
    "track.mesh": () => setOverlays((now) => ({ ...now, mesh: !now.mesh })),
    "track.skeleton": () => setOverlays((now) => ({ ...now, skeleton: !now.skeleton })),
  });

  const describe = (at: number): string => {
    const index = frames.frame.indexOf(at);
    if (index < 0) return `frame ${at}: not in this track`;
    return `frame ${at}: ${frames.status[index] ?? "?"}, ${formatMeasure(error.values[index], error.unit)}`;
  };

  return (
    <div className={classes.page}>
      <h1 className="visually-hidden">
        {track.name} of {recording.name}
      </h1>
      <TrackBar
        track={track}
        recording={recording}
        frame={frame}
        status={frames.status[frames.frame.indexOf(frame)] ?? null}
        isPlaying={isPlaying}
        hasLost={lost.length > 0}
        camera={isAll ? ALL : (camera?.id ?? "")}
        all={ALL}
        onCamera={setCameraId}
        onPlay={play}
        onStep={(by) => seek(frame + by)}
        onBad={toBad}
        onAnnotate={annotate}
      />
      {isCompact && (
        <SegmentedControl
          fullWidth
          m={8}
          mb={0}
          flex="none"
          aria-label="What is shown"
          data={[
            { value: "image", label: "Picture" },
            { value: "space", label: "3D view" },
          ]}
          value={shown}
          onChange={(value) => setShown(value)}
        />
      )}
      <div className={classes.middle} data-shown={shown}>
        {(!isCompact || hasSpace.current) && <ViewerFrame viewer={viewer} frame={frame} layers={layers} terms={terms} onLayers={setLayers} onTerms={setTerms} />}
        <div className={classes.side}>
          {cameras.length > 0 && (
            <TrackPictures
              track={track}
              recording={recording}
              cameras={cameras}
              frame={frame}
              overlays={overlays}
              onOverlays={setOverlays}
              onStep={(by) => seek(frame + by)}
              onChoose={setCameraId}
              ready={readyPictures}
            />
          )}
          <TrackPlots onCamera={setCameraId} track={track} frames={frames} lost={lost} frame={frame} camera={camera?.id ?? ""} tab={tab} onTab={setTab} onSeek={seek} />
        </div>
      </div>
      <div className={classes.timeline}>
        <ErrorLegend error={error} hasLost={lost.length > 0} />
        <FrameStrip rows={rows} frameCount={recording.frame_count} frame={frame} height={lost.length > 0 ? 34 : 24} label="Timeline" onSeek={seek} describe={describe} />
      </div>
    </div>
  );
}
