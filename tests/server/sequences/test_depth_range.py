"""Near and far of a depth camera: hardly a value lies outside, and a recording without depth has a usual range."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest

from server.sequences.depth_range import SAMPLES, measure_depth_range
from tests.server.conftest import MakeRecording
from tracker import load_sequence


def write(folder: Path, frames: dict[int, np.ndarray]) -> Path:
    """Depth of some frames, raw."""
    for frame, values in frames.items():
        cv2.imwrite(str(folder / f"depth/{frame:06d}.png"), np.broadcast_to(values, (24, 32)).astype(np.uint16))
    return folder


def measure(folder: Path) -> tuple[float, float]:
    return measure_depth_range(load_sequence(folder), "cam0")


def test_one_in_a_hundred_values_is_nearer_and_one_farther_and_holes_count_for_nothing(
    make_recording: MakeRecording, rng: np.random.Generator
) -> None:
    images = {frame: rng.integers(300, 1200, (24, 32)) for frame in range(3)}
    for image in images.values():
        image[rng.random(image.shape) < 0.4] = 0
    found = measure(write(make_recording(frames=3), images))
    values = np.concatenate([image[image > 0] for image in images.values()]) * 0.001
    assert found == tuple(np.round(np.percentile(values, (1, 99)), 4))


def test_some_frames_evenly_over_the_recording_are_looked_at(make_recording: MakeRecording) -> None:
    """Each of them alone has its depth: so as many are seen as are sampled, the first and the last among them."""
    count = 5 * SAMPLES
    folder = write(make_recording(frames=count), {frame: np.array(500) for frame in range(count)})
    assert measure(folder) == (0.5, 0.51)
    write(folder, {0: np.array(100), count - 1: np.array(1000)})
    assert measure(folder) == (0.1, 1.0)
    between = {frame: np.array(60000) for frame in range(1, 5)}
    assert measure(write(folder, between)) == (0.1, 1.0), "no frame between the first two that are looked at counts"


def test_a_damaged_frame_is_passed_over(make_recording: MakeRecording) -> None:
    folder = write(make_recording(frames=3), {frame: np.array(500 + 100 * frame) for frame in range(3)})
    (folder / "depth/000002.png").write_bytes(b"no image")
    assert measure(folder) == (0.5, 0.6)


@pytest.mark.parametrize("is_damaged", [False, True])
def test_without_any_depth_the_range_is_a_usual_one(make_recording: MakeRecording, is_damaged: bool) -> None:
    folder = write(make_recording(frames=2), {frame: np.array(0) for frame in range(2)})
    for frame in range(2 * is_damaged):
        (folder / f"depth/{frame:06d}.png").write_bytes(b"")
    assert measure(folder) == (0.2, 1.5)


def test_near_and_far_never_meet(make_recording: MakeRecording) -> None:
    near, far = measure(write(make_recording(frames=1), {0: np.array(700)}))
    assert (near, far) == (0.7, pytest.approx(0.71))
