/** How several pictures share a space. */

import type { Size } from "../canvas/view";

export interface Cell {
  /** From 0. */
  readonly column: number;
  readonly row: number;
  readonly columnSpan: number;
  readonly rowSpan: number;
}

export interface PaneGrid {
  /** Shares of the width, and of the height. */
  readonly columns: readonly number[];
  readonly rows: readonly number[];
  readonly cells: readonly Cell[];
}

/** How large the enlarged picture is beside a column of the others. */
const LARGE_SHARE = 3;

/** Columns that make the pictures largest. */
function bestColumns(count: number, space: Size, image: Size): number {
  let best = 1;
  let bestScale = 0;
  for (let columns = 1; columns <= count; columns += 1) {
    const rows = Math.ceil(count / columns);
    const scale = Math.min(space.width / columns / image.width, space.height / rows / image.height);
    if (scale > bestScale * 1.001) [best, bestScale] = [columns, scale];
  }
  return best;
}

/** Cells for `count` pictures of about the size `image`; with `large`, that one has the left part to itself. */
export function arrangePanes(count: number, space: Size, image: Size, large: number | null = null): PaneGrid {
  const ones = (length: number): number[] => Array.from({ length }, () => 1);
  if (large !== null && count > 1) {
    const others = count - 1;
    const columns = others > 4 ? 2 : 1;
    const rows = Math.ceil(others / columns);
    let next = 0;
    const cells = Array.from({ length: count }, (_, pane): Cell => {
      if (pane === large) return { column: 0, row: 0, columnSpan: 1, rowSpan: rows };
      const at = next;
      next += 1;
      return { column: 1 + (at % columns), row: Math.floor(at / columns), columnSpan: 1, rowSpan: 1 };
    });
    return { columns: [LARGE_SHARE * (columns === 1 ? 1 : 1.2), ...ones(columns)], rows: ones(rows), cells };
  }
  const columns = bestColumns(count, space, image);
  const rows = Math.ceil(count / columns);
  const cells = Array.from({ length: count }, (_, pane): Cell => {
    const [column, row] = [pane % columns, Math.floor(pane / columns)];
    // The last one of an unfilled row takes the rest of it.
    const isLast = pane === count - 1;
    return { column, row, columnSpan: isLast ? columns - column : 1, rowSpan: 1 };
  });
  return { columns: ones(columns), rows: ones(rows), cells };
}

/** Shares after the border behind `index` was dragged by a part of the whole; no pane gets smaller than a tenth of its neighbours' sum. */
export function moveBorder(shares: readonly number[], index: number, by: number): number[] {
  const [a, b] = [shares[index] ?? 0, shares[index + 1] ?? 0];
  const total = shares.reduce((sum, share) => sum + share, 0);
  const least = 0.1 * (a + b);
  const moved = Math.min(a + b - least, Math.max(least, a + by * total));
  return shares.map((share, at) => (at === index ? moved : at === index + 1 ? a + b - moved : share));
}
