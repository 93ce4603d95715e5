"""The results of some consecutive frames, as a job stores them."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Sequence as Several
from dataclasses import MISSING, dataclass, field, fields
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.fitting.quality import Quality
from tracker.tracking.arrays_file import load_arrays, save_arrays
from tracker.tracking.frame_result import STATUSES, FrameResult
from tracker.tracking.watch_objects import OBJECT_STATUSES

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class TrackChunk:
    """Columns of T frames.

    Attributes:
        frame: (T,) numbers.
        pose: (T, D).
        status: (T,) index into STATUSES.
        seconds: (T,).
        depth_residual_mm: (T,) NaN where there was nothing to compare.
        silhouette_iou: (T,) likewise.
        score: (T,) likewise.
        iterations: (T,).
        cost_names: (N,) names of terms.
        costs: (T, N) cost of each term at the last iteration, mm².
        stage_names: (S,) names of stages.
        stages: (T, S) seconds.
        iteration_costs: (T, I, N) float32, cost of each term at every iteration of the fit that was kept, mm²; NaN
            after a frame's last iteration and where a term had no part. I is 0 in tracks made before it was recorded.
        object_status: (T, O) index into OBJECT_STATUSES. O is 0 in tracks made before it was recorded.
        hand_status: (T, H) index into STATUSES. H is 0 in tracks made before it was recorded.
        seen: (T, C, H, 21, 2) float32, where the detector saw the joints in each of the run's colour views, px as
            recorded; NaN where it saw none. C is 0 where one depth camera is tracked in, and in tracks made before it
            was recorded.
        object_score: (T, O) how well each object's pose explains what is in sight of it, 0 to 1.
    """

    frame: npt.NDArray[np.int64]
    pose: Array
    status: npt.NDArray[np.int8]
    seconds: Array
    depth_residual_mm: Array
    silhouette_iou: Array
    score: Array
    iterations: npt.NDArray[np.int64]
    cost_names: npt.NDArray[np.str_]
    costs: Array
    stage_names: npt.NDArray[np.str_]
    stages: Array
    iteration_costs: npt.NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 0), dtype=np.float32))
    object_status: npt.NDArray[np.int8] = field(default_factory=lambda: np.zeros((0, 0), dtype=np.int8))
    object_score: Array = field(default_factory=lambda: np.zeros((0, 0)))
    hand_status: npt.NDArray[np.int8] = field(default_factory=lambda: np.zeros((0, 0), dtype=np.int8))
    seen: npt.NDArray[np.float32] = field(default_factory=lambda: np.zeros((0, 0, 0, 21, 2), dtype=np.float32))

    @classmethod
    def of(cls, results: Several[FrameResult]) -> TrackChunk:
        """Columns from at least one result."""
        assert results, "a chunk has at least one frame"
        cost_names = sorted({name for result in results for costs in result.costs for name in costs})
        stage_names = sorted({name for result in results for name in result.stages})

        def column(read: Callable[[FrameResult], Any], dtype: npt.DTypeLike = np.float64) -> np.ndarray:
            return np.array([read(result) for result in results], dtype=dtype)

        def table(read: Callable[[FrameResult], Any], dtype: npt.DTypeLike = np.int8) -> np.ndarray:
            return column(read, dtype).reshape(len(results), -1)  # also where a frame has no columns

        def judge(read: Callable[[Quality], float]) -> Array:
            return column(lambda result: read(result.quality) if result.quality else np.nan)

        return cls(
            frame=column(lambda result: result.frame, np.int64),
            pose=column(lambda result: result.pose),
            status=column(lambda result: STATUSES.index(result.status), np.int8),
            seconds=column(lambda result: result.seconds),
            depth_residual_mm=judge(lambda quality: 1000.0 * quality.depth_residual),
            silhouette_iou=judge(lambda quality: quality.silhouette_iou),
            score=judge(lambda quality: quality.score),
            iterations=column(lambda result: len(result.costs), np.int64),
            cost_names=np.array(cost_names, dtype=np.str_),
            costs=_tabulate([result.costs[-1:] for result in results], cost_names, 0.0)[:, 0],
            stage_names=np.array(stage_names, dtype=np.str_),
            stages=_tabulate([(result.stages,) for result in results], stage_names, 0.0)[:, 0],
            iteration_costs=_tabulate([result.costs for result in results], cost_names, np.nan).astype(np.float32),
            object_status=table(lambda result: [OBJECT_STATUSES.index(one.status) for one in result.objects]),
            hand_status=table(lambda result: [STATUSES.index(status) for status in result.hand_status]),
            object_score=table(lambda result: [one.quality.score for one in result.objects], np.float64),
            seen=np.stack([result.seen for result in results]),
        )

    @classmethod
    def join(cls, chunks: Several[TrackChunk]) -> TrackChunk:
        """Consecutive chunks as one."""
        assert chunks, "at least one chunk"
        costs = sorted({str(name) for chunk in chunks for name in chunk.cost_names})
        stages = sorted({str(name) for chunk in chunks for name in chunk.stage_names})
        joined = {
            "cost_names": np.array(costs, dtype=np.str_),
            "costs": _join([(chunk.costs[:, None], chunk.cost_names) for chunk in chunks], costs, 0.0)[:, 0],
            "stage_names": np.array(stages, dtype=np.str_),
            "stages": _join([(chunk.stages[:, None], chunk.stage_names) for chunk in chunks], stages, 0.0)[:, 0],
            "iteration_costs": _join([(one.iteration_costs, one.cost_names) for one in chunks], costs, float("nan")),
        }
        rest = [f.name for f in fields(cls) if f.name not in joined]
        return cls(**joined, **{name: np.concatenate([getattr(chunk, name) for chunk in chunks]) for name in rest})

    def save(self, path: Path) -> None:
        """Write to an npz file, whole or not at all."""
        save_arrays(path, {f.name: getattr(self, f.name) for f in fields(self)})

    @classmethod
    def load(cls, path: Path) -> TrackChunk:
        """Read what `save` wrote, or what it wrote before the costs of iterations and the objects were recorded."""
        later = {f.name: f.default_factory() for f in fields(cls) if f.default_factory is not MISSING}
        arrays = load_arrays(path, tuple(f.name for f in fields(cls) if f.name not in later), optional=tuple(later))
        frames = len(arrays["frame"])
        nothing: dict[str, np.ndarray] = {
            name: np.zeros((frames, *column.shape[1:]), column.dtype) for name, column in later.items()
        }
        nothing["iteration_costs"] = np.zeros((frames, 0, len(arrays["cost_names"])), dtype=np.float32)
        return cls(**{**nothing, **arrays})


def _tabulate(frames: Several[Several[dict[str, float]]], names: list[str], fill: float) -> Array:
    """(T, I, N) named values of each frame's iterations, I at least 1; `fill` where there are none."""
    table = np.full((len(frames), max(1, *(len(rows) for rows in frames)), len(names)), fill)
    for place, rows in enumerate(frames):
        for iteration, values in enumerate(rows):
            table[place, iteration] = [values.get(name, fill) for name in names]
    return table


def _join(parts: Several[tuple[np.ndarray, npt.NDArray[np.str_]]], names: list[str], fill: float) -> np.ndarray:
    """(T, I, N) tables with the names of their last axes, one after the other; `fill` where one has nothing."""
    most = max(table.shape[1] for table, _ in parts)
    joined = np.full((sum(len(table) for table, _ in parts), most, len(names)), fill, dtype=parts[0][0].dtype)
    row = 0
    for table, own in parts:
        if table.size:
            joined[row : row + len(table), : table.shape[1], [names.index(str(name)) for name in own]] = table
        row += len(table)
    return joined
