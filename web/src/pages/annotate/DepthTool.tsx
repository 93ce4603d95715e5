import { Button, Group, RangeSlider, Slider, Stack, Text } from "@mantine/core";
import { IconStack2 } from "@tabler/icons-react";
import { useMemo } from "react";
import { findRange, histogramOf, PALETTE_ANCHORS, PALETTE_NAMES, type Palette } from "../../canvas/depth";
import { useAnnotating } from "./annotating";
import { useArrangement, useOption, usePage, usePicturesHere } from "./reading";
import classes from "./DepthTool.module.css";
import { ToolPopover } from "./ToolPopover";

const BINS = 64;
const NAMES: Record<Palette, string> = { warm: "Warm", viridis: "Viridis", turbo: "Turbo", grey: "Grey" };
const cssOf = (palette: Palette): string => `linear-gradient(90deg, ${PALETTE_ANCHORS[palette].map((rgb) => `rgb(${rgb.join(" ")})`).join(", ")})`;

/** How depth is coloured: which map, over which distances, and how strongly over the colour image. */
function DepthColors() {
  const { setOptions, show } = useAnnotating();
  const range = usePage((page) => page.range);
  const arrangement = useArrangement();
  const [chosen, opacity] = [useOption("palette"), useOption("depthOpacity")];
  const image = usePicturesHere((pictures) => pictures?.depthImage ?? null);
  // Room on both sides of what the image holds, so that the handles have somewhere to go.
  const limits = useMemo(() => {
    if (!image) return { near: 0, far: 2 };
    const found = findRange(image);
    return { near: Math.max(0, Math.floor(10 * (found.near - 0.15)) / 10), far: Math.ceil(10 * (found.far + 0.3)) / 10 };
  }, [image]);
  const bars = useMemo(() => (image ? histogramOf(image, limits, BINS) : []), [image, limits]);
  const used = usePicturesHere((pictures) => pictures?.range ?? null) ?? limits;
  const share = (metres: number): number => Math.min(100, Math.max(0, ((metres - limits.near) / (limits.far - limits.near)) * 100));
  return (
    <Stack gap="sm">
      <div role="radiogroup" aria-label="Colour map" className={classes.maps}>
        {PALETTE_NAMES.map((palette) => (
          <button key={palette} type="button" role="radio" aria-checked={chosen === palette} className={classes.map} onClick={() => setOptions({ palette })}>
            <span style={{ background: cssOf(palette) }} />
            {NAMES[palette]}
          </button>
        ))}
      </div>
      <div>
        <svg className={classes.bars} viewBox={`0 0 ${BINS} 40`} preserveAspectRatio="none" aria-hidden>
          {bars.map((bar, index) => (
            <rect key={index} x={index} y={40 - 40 * bar} width={0.85} height={40 * bar} />
          ))}
        </svg>
        <div className={classes.ramp} style={{ marginLeft: `${share(used.near)}%`, marginRight: `${100 - share(used.far)}%`, background: cssOf(chosen) }} />
        <RangeSlider
          size="sm"
          min={limits.near}
          max={limits.far}
          step={0.005}
          minRange={0.02}
          thumbFromLabel="Nearest distance"
          thumbToLabel="Farthest distance"
          value={[Math.max(limits.near, used.near), Math.min(limits.far, used.far)]}
          onChange={([near, far]) => show({ range: { near, far } })}
          label={null}
        />
        <Group justify="space-between" mt={4}>
          <Text size="xs">{used.near.toFixed(3)} m</Text>
          <Text size="xs" className="quiet">
            {image ? "pixels by distance" : "no depth image yet"}
          </Text>
          <Text size="xs">{used.far.toFixed(3)} m</Text>
        </Group>
      </div>
      {arrangement === "over" && (
        <div>
          <Text size="xs" mb={4}>
            Depth over colour, {Math.round(100 * opacity)} %
          </Text>
          <Slider aria-label="Strength of depth over colour" thumbLabel="Strength of depth over colour" min={0.05} max={1} step={0.05} value={opacity} onChange={(depthOpacity) => setOptions({ depthOpacity })} label={null} />
        </div>
      )}
      <Button size="xs" variant="default" disabled={range === null} onClick={() => show({ range: null })}>
        Range from the image
      </Button>
    </Stack>
  );
}

export function DepthTool() {
  const isSeen = useArrangement() !== "color";
  const isChosen = usePage((page) => page.range !== null);
  const isPainted = useOption("palette") !== "warm";
  return (
    <ToolPopover label={isSeen ? "Depth colours" : "Depth colours (where depth is shown)"} isDisabled={!isSeen} icon={<IconStack2 size={18} />} isOn={isChosen || isPainted} width={288}>
      {() => <DepthColors />}
    </ToolPopover>
  );
}
