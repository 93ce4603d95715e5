import { expect, test } from "vitest";
import { arrangePanes, moveBorder } from "./paneGrid";

const image = { width: 640, height: 480 };
const shape = (count: number, width: number, height: number) => {
  const { columns, rows } = arrangePanes(count, { width, height }, image);
  return `${columns.length}x${rows.length}`;
};

test("pictures share the space so that they are as large as can be", () => {
  expect([1, 2, 3, 4, 6, 8].map((count) => shape(count, 1000, 560))).toEqual(["1x1", "2x1", "2x2", "2x2", "3x2", "4x2"]);
  expect(shape(2, 500, 900)).toBe("1x2");
});

test("no two panes overlap and the last one fills its row", () => {
  for (let count = 1; count <= 8; count += 1) {
    for (const large of [null, 0, count - 1]) {
      const grid = arrangePanes(count, { width: 1400, height: 700 }, image, large);
      const taken = grid.cells.flatMap(({ column, row, columnSpan, rowSpan }) =>
        Array.from({ length: columnSpan * rowSpan }, (_, k) => `${column + (k % columnSpan)},${row + Math.floor(k / columnSpan)}`),
      );
      expect(new Set(taken).size).toBe(taken.length);
      expect(grid.cells).toHaveLength(count);
      if (large === null) expect(taken).toHaveLength(grid.columns.length * grid.rows.length);
    }
  }
});

test("the enlarged pane has the left part from top to bottom", () => {
  const { cells, rows, columns } = arrangePanes(4, { width: 1000, height: 560 }, image, 2);
  expect(cells[2]).toEqual({ column: 0, row: 0, columnSpan: 1, rowSpan: 3 });
  expect([columns, rows.length]).toEqual([[3, 1], 3]);
});

test("a border moves between its two neighbours and leaves both a place", () => {
  expect(moveBorder([1, 1, 1], 0, 1 / 6)).toEqual([1.5, 0.5, 1]);
  expect(moveBorder([1, 1], 0, 5)[1]).toBeCloseTo(0.2);
  expect(moveBorder([1, 1], 0, -5)[0]).toBeCloseTo(0.2);
});
