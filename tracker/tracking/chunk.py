"""The results of some consecutive frames, as a job stores them."""

from __future__ import annotations

from collections.abc import Sequence as Several
from dataclasses import dataclass, field, fields
from pathlib import Path

import numpy as np
import numpy.typing as npt

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
        cost_names = _names([costs for result in results for costs in result.costs])
        stage_names = _names([result.stages for result in results])
        qualities = [result.quality for result in results]
        nan = float("nan")
        return cls(
            frame=np.array([result.frame for result in results], dtype=np.int64),
            pose=np.stack([result.pose for result in results]),
            status=np.array([STATUSES.index(result.status) for result in results], dtype=np.int8),
            seconds=np.array([result.seconds for result in results]),
            depth_residual_mm=np.array([1000.0 * q.depth_residual if q else nan for q in qualities]),
            silhouette_iou=np.array([q.silhouette_iou if q else nan for q in qualities]),
            score=np.array([q.score if q else nan for q in qualities]),
            iterations=np.array([len(result.costs) for result in results], dtype=np.int64),
            cost_names=np.array(cost_names, dtype=np.str_),
            costs=_table([result.costs[-1] if result.costs else {} for result in results], cost_names),
            stage_names=np.array(stage_names, dtype=np.str_),
            stages=_table([result.stages for result in results], stage_names),
            iteration_costs=_tabulate_iterations([result.costs for result in results], cost_names),
            object_status=np.array(
                [[OBJECT_STATUSES.index(one.status) for one in result.objects] for result in results], dtype=np.int8
            ).reshape(len(results), -1),
            hand_status=np.array(
                [[STATUSES.index(status) for status in result.hand_status] for result in results], dtype=np.int8
            ).reshape(len(results), -1),
            object_score=np.array([[one.quality.score for one in result.objects] for result in results]).reshape(
                len(results), -1
            ),
            seen=np.stack([result.seen for result in results]),
        )

    @classmethod
    def join(cls, chunks: Several[TrackChunk]) -> TrackChunk:
        """Consecutive chunks as one."""
        assert chunks, "at least one chunk"
        cost_names = sorted({str(name) for chunk in chunks for name in chunk.cost_names})
        stage_names = sorted({str(name) for chunk in chunks for name in chunk.stage_names})
        plain = ("frame", "pose", "status", "seconds", "depth_residual_mm", "silhouette_iou", "score", "iterations")
        plain = (*plain, "object_status", "object_score", "hand_status", "seen")
        return cls(
            **{name: np.concatenate([getattr(chunk, name) for chunk in chunks]) for name in plain},
            cost_names=np.array(cost_names, dtype=np.str_),
            costs=np.concatenate([_widen(chunk.costs, chunk.cost_names, cost_names) for chunk in chunks]),
            stage_names=np.array(stage_names, dtype=np.str_),
            stages=np.concatenate([_widen(chunk.stages, chunk.stage_names, stage_names) for chunk in chunks]),
            iteration_costs=_join_iterations(chunks, cost_names),
        )

    def save(self, path: Path) -> None:
        """Write to an npz file, whole or not at all."""
        save_arrays(path, {f.name: getattr(self, f.name) for f in fields(self)})

    @classmethod
    def load(cls, path: Path) -> TrackChunk:
        """Read what `save` wrote, or what it wrote before the costs of iterations and the objects were recorded."""
        later = ("iteration_costs", "object_status", "object_score", "hand_status", "seen")
        arrays = load_arrays(path, tuple(f.name for f in fields(cls) if f.name not in later), optional=later)
        frames = len(arrays["frame"])
        nothing = {
            "iteration_costs": np.zeros((frames, 0, len(arrays["cost_names"])), dtype=np.float32),
            "object_status": np.zeros((frames, 0), dtype=np.int8),
            "object_score": np.zeros((frames, 0)),
            "hand_status": np.zeros((frames, 0), dtype=np.int8),
            "seen": np.zeros((frames, 0, 0, 21, 2), dtype=np.float32),
        }
        return cls(**{**nothing, **arrays})


def _names(rows: Several[dict[str, float]]) -> list[str]:
    return sorted({name for row in rows for name in row})


def _table(rows: Several[dict[str, float]], names: list[str]) -> Array:
    return np.array([[row.get(name, 0.0) for name in names] for row in rows]).reshape(len(rows), len(names))


def _widen(table: Array, have: npt.NDArray[np.str_], want: list[str]) -> Array:
    wide = np.zeros((len(table), len(want)))
    for column, name in enumerate(have):
        wide[:, want.index(str(name))] = table[:, column]
    return wide


def _tabulate_iterations(frames: Several[tuple[dict[str, float], ...]], names: list[str]) -> npt.NDArray[np.float32]:
    """(T, I, N) costs of each frame's iterations, NaN where there are none."""
    most = max(1, *(len(costs) for costs in frames))
    table = np.full((len(frames), most, len(names)), np.nan, dtype=np.float32)
    for row, costs in enumerate(frames):
        for iteration, values in enumerate(costs):
            for column, name in enumerate(names):
                table[row, iteration, column] = values.get(name, np.nan)
    return table


def _join_iterations(chunks: Several[TrackChunk], names: list[str]) -> npt.NDArray[np.float32]:
    most = max(chunk.iteration_costs.shape[1] for chunk in chunks)
    joined = np.full((sum(len(chunk.frame) for chunk in chunks), most, len(names)), np.nan, dtype=np.float32)
    row = 0
    for chunk in chunks:
        columns = [names.index(str(name)) for name in chunk.cost_names]
        iterations = chunk.iteration_costs.shape[1]
        if iterations:
            joined[row : row + len(chunk.frame), :iterations, columns] = chunk.iteration_costs
        row += len(chunk.frame)
    return joined
