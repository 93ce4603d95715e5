import { readSessionStorageValue, useSessionStorage } from "@mantine/hooks";
import { useMemo, useRef, useState } from "react";
import { useSaveCrop, useScanCrop, type Scan, type ScanCrop } from "../../api/scans";
import type { HandGeometry } from "../../canvas/hand3d/geometry";
import { countTaken, cutOf, readStroke, smallerSide, takenByAny, type Cut, type Point, type Projection, type Stroke } from "../../model/crop";
import { cropKey } from "../../state/elsewhere";

/** What is not saved yet: the strokes as they should be, and those taken back. */
interface Draft {
  /** Revision of the crop that it was made from. */
  readonly base: number;
  readonly cuts: readonly Cut[];
  readonly undone: readonly Cut[];
  readonly dropsObjects: boolean;
  /** Metres per unit of the scan when it was drawn. */
  readonly unit?: number | null;
}

/** A draft for the scan at the size that it has now: a corrected unit scales the strokes with the scan. */
function fitDraft(draft: Draft | null, unit: number | null): Draft | null {
  if (!draft || draft.unit === undefined || draft.unit === unit) return draft;
  if (draft.unit === null || unit === null) return null;
  const factor = unit / draft.unit;
  const fit = (cut: Cut): Cut =>
    cut.kind === "plane" ? { ...cut, offset: cut.offset * factor } : { ...cut, view: cut.view.map((value, at) => (at % 4 < 3 ? value / factor : value)) };
  return { ...draft, unit, cuts: draft.cuts.map(fit), undone: draft.undone.map(fit) };
}

interface LastStroke {
  readonly stroke: Stroke;
  readonly side: number;
  readonly projection: Projection;
  /** How many cuts there were with it. */
  readonly count: number;
}

/** Green things in the hand, as the server leaves them out: G > max(R, 20) [R17, 3.1]. */
const isOfObject = (colors: Uint8Array, point: number): boolean => (colors[3 * point + 1] as number) > Math.max(colors[3 * point] as number, 20);

/** The crop of a scan: strokes with undo, kept over a reload until they are saved. */
export function useCrop(scan: Scan, geometry: HandGeometry | null) {
  const saved = useScanCrop(scan).data;
  const key = cropKey(scan.id);
  const [stored, setDraft, dropDraft] = useSessionStorage<Draft | null>({ key, defaultValue: null, getInitialValueInEffect: false });
  const kept = useMemo(() => fitDraft(stored, scan.metres_per_unit), [stored, scan.metres_per_unit]);
  const [last, setLast] = useState<LastStroke | null>(null);
  const sent = useRef("");
  const save = useSaveCrop(({ revision }) => {
    // What was drawn or taken back while it was sent, even on a page opened anew, is the next thing to save.
    const now = readSessionStorageValue<Draft | null>({ key, defaultValue: null });
    if (now && JSON.stringify(now) !== sent.current) setDraft({ ...now, base: revision });
    else dropDraft();
  });

  const draft = useMemo<Draft>(() => kept ?? { base: scan.revision, cuts: (saved?.strokes as readonly Cut[] | undefined) ?? [], undone: [], dropsObjects: saved?.drops_objects ?? false }, [kept, saved, scan.revision]);
  const taken = useMemo(() => {
    if (!geometry) return null;
    const { positions, colors } = geometry.scan;
    const all = takenByAny(draft.cuts, positions);
    if (draft.dropsObjects && colors) for (let point = 0; point < all.length; point += 1) if (isOfObject(colors, point)) all[point] = 1;
    return all;
  }, [geometry, draft]);

  const isReady = saved !== undefined && geometry !== null;
  // Strokes belong to the scan on the screen: none is drawn or taken back before it is there.
  const set = (next: Partial<Draft>): void => {
    if (isReady) setDraft({ ...draft, ...next, unit: scan.metres_per_unit });
  };
  const canFlip = last?.stroke.kind === "line" && last.count === draft.cuts.length;
  return {
    draft,
    taken,
    share: taken && taken.length > 0 ? countTaken(taken) / taken.length : 0,
    isChanged: kept !== null,
    /** Nothing can be drawn before it is known what is cropped already. */
    isReady,
    save,
    canFlip,
    cut: (points: readonly Point[], projection: Projection): void => {
      const stroke = readStroke(points);
      if (!stroke || !geometry || !saved) return;
      const side = smallerSide(stroke, projection, geometry.scan.positions);
      const corners = stroke.polygons[side];
      if (!corners) return;
      setLast({ stroke, side, projection, count: draft.cuts.length + 1 });
      set({ cuts: [...draft.cuts, cutOf(corners, projection)], undone: [] });
    },
    flip: (): void => {
      if (!last || !canFlip) return;
      const side = 1 - last.side;
      const corners = last.stroke.polygons[side];
      if (!corners) return;
      setLast({ ...last, side });
      set({ cuts: [...draft.cuts.slice(0, -1), cutOf(corners, last.projection)] });
    },
    undo: (): void => {
      const gone = draft.cuts.at(-1);
      if (gone) set({ cuts: draft.cuts.slice(0, -1), undone: [...draft.undone, gone] });
    },
    redo: (): void => {
      const back = draft.undone.at(-1);
      if (back) set({ cuts: [...draft.cuts, back], undone: draft.undone.slice(0, -1) });
    },
    clear: (): void => {
      if (draft.cuts.length > 0) set({ cuts: [], undone: [] });
    },
    setDropsObjects: (dropsObjects: boolean): void => set({ dropsObjects }),
    /** As the server has it. */
    drop: (): void => {
      dropDraft();
      save.reset();
    },
    /** Somebody else has cropped it meanwhile, and what is drawn here was not made from that. */
    isOvertaken: kept !== null && kept.base !== scan.revision,
    /** Over the crop it was made from, or over somebody else's when that was asked for. */
    store: (revision: number = draft.base): void => {
      if (save.isPending) return;
      sent.current = JSON.stringify(kept);
      save.mutate({ scan: { ...scan, revision }, crop: { strokes: draft.cuts as unknown as ScanCrop["strokes"], drops_objects: draft.dropsObjects } });
    },
  };
}

export type Crop = ReturnType<typeof useCrop>;
