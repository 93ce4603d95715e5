"""Algorithm 1 alone follows a rendered hand, and pooling several runs is the same as one long run."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.studies.plain_run import PlainRun, follow_plainly, pool
from benchmarks.studies.twin_runs import Twin, measure, render_into, start_twin
from tracker.capture.sequence import load_sequence
from tracker.capture.truth import load_truth
from tracker.fitting.options import TrackOptions
from tracker.model import save_model
from tracker.model.default_hand import default_hand
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.track import join_chunks

FRAMES = 5


@pytest.fixture(scope="module")
def twin(tmp_path_factory: pytest.TempPathFactory) -> Twin:
    """Five frames of a hand that opens and closes."""
    folder: Path = tmp_path_factory.mktemp("twin") / "recording"
    performance = perform({"right": default_hand("right")}, "open-close", FRAMES)
    write_recording(performance, folder, RecordingOptions(range(FRAMES)), save_model)
    return Twin(performance, load_sequence(folder), load_truth(folder / "truth.npz"))


def follow(twin: Twin, run: PlainRun) -> dict:
    options = TrackOptions(calibrate=False, first_iterations=15, stop_below_mm=run.stop_below_mm)
    setup, state = start_twin(twin, options)
    chunk = follow_plainly(run, twin.sequence, setup, state)
    found = measure(twin, join_chunks(twin.sequence, setup, [chunk]), penetration=True)
    return found | {"iterations": chunk.iterations.tolist()}


def test_a_rendered_hand_is_followed(twin):
    found = follow(twin, PlainRun("toy", 1, iterations=5))
    assert found["frames"] == FRAMES and found["hands"] == 1
    assert found["lost"] == 0 and found["worst_mm"] < 3.0 and found["px"] < 1.5
    assert found["iterations"] == [15, 5, 5, 5, 5]


def test_parts_of_the_objective_can_be_chosen(twin):
    assert set(PlainRun("toy", 1, data="m2d").objective().terms) == {"model_to_data"}
    assert set(PlainRun("toy", 1, data="paper", collision=1.0, salient=0.02).objective().terms) == {
        "model_to_data",
        "data_to_model",
        "collision",
        "salient",
    }
    salient = PlainRun("toy", 1, salient=0.012, use_confidence=True).objective().terms["salient"]
    assert salient.salient.rejection == 0.012 and salient.salient.use_confidence


def test_stopping_early_needs_fewer_iterations(twin):
    found = follow(twin, PlainRun("toy", 1, iterations=30, stop_below_mm=2.0))
    assert max(found["iterations"][1:]) < 15
    assert found["lost"] == 0


def test_pooled_runs_are_as_one():
    rng = np.random.default_rng(0)
    errors = [rng.gamma(2.0, size=(frames, hands, 21)) for frames, hands in ((7, 1), (3, 2))]
    runs = [
        {
            "frames": len(error),
            "hands": error.shape[1],
            "px": error.mean(),
            "px_std": error.std(),
            "px_max": error.max(),
            "mm": error.mean(),
            "worst_mm": error.mean(axis=2).max(),
            "lost": lost,
        }
        for error, lost in zip(errors, (0, 2), strict=True)
    ]
    whole = np.concatenate([error.ravel() for error in errors])
    pooled = pool(runs)
    assert pooled["px"] == pytest.approx(whole.mean())
    assert pooled["px_std"] == pytest.approx(whole.std())
    assert pooled["px_max"] == whole.max()
    assert (pooled["frames"], pooled["lost"], pooled["failed"], pooled["sequences"]) == (10, 2, 1, 2)


def test_a_twin_is_there_whole_or_not_at_all(tmp_path):
    performance = perform({"right": default_hand("right")}, "wave", 2)
    folder = tmp_path / "twins" / "toy"
    for _ in range(2):  # the second finds the first's
        render_into(folder, performance, RecordingOptions(range(2)))
    assert load_sequence(folder).frame_count == 2 and len(load_truth(folder / "truth.npz").frame) == 2
    assert [path.name for path in folder.parent.iterdir()] == ["toy"], "nothing half written is left"
