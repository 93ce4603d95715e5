import { useElementSize, useLocalStorage } from "@mantine/hooks";
import { useRef, type KeyboardEvent, type PointerEvent } from "react";
import { arrangePanes, moveBorder } from "../../model/paneGrid";
import classes from "./CameraGrid.module.css";
import { CameraPane } from "./CameraPane";
import { useLargeCamera, useShownCameras } from "./reading";

type Shares = Readonly<Record<string, readonly number[]>>;

interface BorderProps {
  direction: "columns" | "rows";
  /** Where it stands, and how large the panes beside it are: parts of the whole. */
  at: number;
  onMove: (by: number) => void;
  onReset: () => void;
}

/** Between two panes: dragged, or moved with the arrow keys; a double click makes all alike again. */
function Border({ direction, at, onMove, onReset }: BorderProps) {
  const last = useRef<number | null>(null);
  const isColumn = direction === "columns";
  const place = (event: PointerEvent): number => (isColumn ? event.clientX : event.clientY);
  const room = (event: PointerEvent): number => {
    const box = event.currentTarget.parentElement?.getBoundingClientRect();
    return (isColumn ? box?.width : box?.height) || 1;
  };
  const step = (event: KeyboardEvent): void => {
    const by = { [isColumn ? "ArrowLeft" : "ArrowUp"]: -0.02, [isColumn ? "ArrowRight" : "ArrowDown"]: 0.02 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    onMove(by);
  };
  return (
    <div
      className={classes.border}
      data-direction={direction}
      style={isColumn ? { left: `${100 * at}%` } : { top: `${100 * at}%` }}
      role="separator"
      aria-orientation={isColumn ? "vertical" : "horizontal"}
      aria-label={isColumn ? "Width of the pictures" : "Height of the pictures"}
      aria-valuenow={Math.round(100 * at)}
      tabIndex={0}
      onKeyDown={step}
      onDoubleClick={onReset}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        last.current = place(event);
      }}
      onPointerMove={(event) => {
        if (last.current === null) return;
        onMove((place(event) - last.current) / room(event));
        last.current = place(event);
      }}
      onPointerUp={() => (last.current = null)}
      onPointerCancel={() => (last.current = null)}
    />
  );
}

/** The shown cameras' pictures side by side. */
export function CameraGrid() {
  const shown = useShownCameras();
  const large = useLargeCamera();
  const { ref, width, height } = useElementSize();
  const [shares, setShares] = useLocalStorage<Shares>({ key: "handloom/panes", defaultValue: {}, getInitialValueInEffect: false });
  const enlarged = shown.findIndex((camera) => camera.id === large);
  const image = { width: Math.max(...shown.map((camera) => camera.width)), height: Math.max(...shown.map((camera) => camera.height)) };
  const grid = arrangePanes(shown.length, { width, height }, image, enlarged < 0 ? null : enlarged);
  const key = `${shown.length}/${grid.columns.length}x${grid.rows.length}${enlarged < 0 ? "" : "+"}`;
  const shareOf = (direction: "columns" | "rows"): readonly number[] => {
    const kept = shares[`${key}/${direction}`];
    return kept?.length === grid[direction].length ? kept : grid[direction];
  };
  const borders = (direction: "columns" | "rows") => {
    const own = shareOf(direction);
    const total = own.reduce((sum, share) => sum + share, 0);
    return own.slice(0, -1).map((_, index) => (
      <Border
        key={`${direction}${index}`}
        direction={direction}
        at={own.slice(0, index + 1).reduce((sum, share) => sum + share, 0) / total}
        onMove={(by) =>
          setShares((now) => {
            const kept = now[`${key}/${direction}`];
            return { ...now, [`${key}/${direction}`]: moveBorder(kept?.length === own.length ? kept : own, index, by) };
          })
        }
        onReset={() => setShares(({ [`${key}/${direction}`]: gone, ...others }) => (void gone, others))}
      />
    ));
  };
  const tracks = (direction: "columns" | "rows"): string => shareOf(direction).map((share) => `minmax(0, ${share}fr)`).join(" ");
  return (
    <div ref={ref} className={classes.grid} style={{ gridTemplateColumns: tracks("columns"), gridTemplateRows: tracks("rows") }} data-testid="camera-grid">
      {width > 0 &&
        shown.map((camera, index) => {
          const cell = grid.cells[index];
          return (
            cell && (
              <div key={camera.id} className={classes.cell} style={{ gridColumn: `${cell.column + 1} / span ${cell.columnSpan}`, gridRow: `${cell.row + 1} / span ${cell.rowSpan}` }}>
                <CameraPane camera={camera} />
              </div>
            )
          );
        })}
      {borders("columns")}
      {enlarged < 0 && borders("rows")}
    </div>
  );
}
