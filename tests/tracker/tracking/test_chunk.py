"""Columns of frames: what a chunk keeps of every iteration, through joining and files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.tracking.arrays_file import save_arrays
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import FrameResult


def frame(number: int, *costs: dict[str, float], status: str = "ok") -> FrameResult:
    return FrameResult(number, np.zeros(6), status, 0.01, None, costs, {"solving": 0.01})


FIRST = TrackChunk.of([frame(0, {"near": 9.0, "edge": 4.0}, {"near": 3.0, "edge": 2.0}), frame(1, {"near": 1.0})])
SECOND = TrackChunk.of([frame(2, status="lost"), frame(3, {"near": 8.0}, {"near": 7.0}, {"near": 6.0, "held": 5.0})])


def column(chunk: TrackChunk, row: int, name: str) -> list[float]:
    return chunk.iteration_costs[row, :, list(chunk.cost_names).index(name)].tolist()


def test_every_iteration_of_every_term_is_kept_and_nan_is_where_there_was_none():
    assert FIRST.iteration_costs.shape == (2, 2, 2)
    assert FIRST.iteration_costs.dtype == np.float32
    assert column(FIRST, 0, "near") == [9.0, 3.0]
    assert np.array_equal(column(FIRST, 1, "near"), [1.0, np.nan], equal_nan=True)
    assert np.isnan(column(FIRST, 1, "edge")).all()


def test_chunks_of_other_terms_and_other_numbers_of_iterations_are_joined():
    joined = TrackChunk.join([FIRST, SECOND])
    assert list(joined.cost_names) == ["edge", "held", "near"]
    assert joined.iteration_costs.shape == (4, 3, 3)
    assert np.array_equal(column(joined, 0, "near"), [9.0, 3.0, np.nan], equal_nan=True)
    assert np.array_equal(column(joined, 3, "held"), [np.nan, np.nan, 5.0], equal_nan=True)
    assert np.isnan(joined.iteration_costs[2]).all(), "nothing was fitted to a lost frame"
    assert joined.costs[3].tolist() == [0.0, 5.0, 6.0]


def test_a_saved_chunk_comes_back_whole(tmp_path: Path):
    FIRST.save(tmp_path / "frames.npz")
    again = TrackChunk.load(tmp_path / "frames.npz")
    assert np.array_equal(again.iteration_costs, FIRST.iteration_costs, equal_nan=True)


def test_a_chunk_from_before_iterations_were_recorded_loads_and_joins_with_a_new_one(tmp_path: Path):
    names = ("frame", "pose", "status", "seconds", "depth_residual_mm", "silhouette_iou", "score", "iterations")
    columns = {name: getattr(FIRST, name) for name in (*names, "cost_names", "costs", "stage_names", "stages")}
    save_arrays(tmp_path / "frames.npz", columns)
    old = TrackChunk.load(tmp_path / "frames.npz")
    assert old.iteration_costs.shape == (2, 0, 2)
    joined = TrackChunk.join([old, SECOND])
    assert np.isnan(joined.iteration_costs[:2]).all()
    assert np.array_equal(column(joined, 3, "near"), [8.0, 7.0, 6.0])
