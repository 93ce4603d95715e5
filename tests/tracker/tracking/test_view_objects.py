"""A box that turns beside a hand before colour cameras: followed with it, and called lost where it is not."""

from __future__ import annotations

import json
import logging
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tracker.capture.sequence import Sequence, load_sequence
from tracker.capture.truth import Truth, load_truth
from tracker.fitting.options import TrackOptions
from tracker.geometry import se3
from tracker.model.default_hand import default_hand
from tracker.model.files import load_model
from tracker.model.npz_files import save_npz_model
from tracker.synthesis.actor import Actor
from tracker.synthesis.motion import perform
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import Track, join_chunks

FRAMES = 6
SIZES = np.array([0.03, 0.06, 0.04])
BOX = """OFF
8 12 0
{vertices}
3 0 2 3
3 0 3 1
3 4 5 7
3 4 7 6
3 0 1 5
3 0 5 4
3 2 6 7
3 2 7 3
3 0 4 6
3 0 6 2
3 1 3 7
3 1 7 5
"""


@pytest.fixture(scope="module")
def turning(tmp_path_factory: pytest.TempPathFactory) -> tuple[Sequence, Truth]:
    """The box goes 4 mm and turns by 3 degrees a frame, before the fingers of a hand that bends them."""
    folder = tmp_path_factory.mktemp("turning")
    corners = [[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)] * SIZES
    lines = "\n".join(" ".join(f"{value:.4f}" for value in corner) for corner in corners)
    (folder / "box.off").write_text(BOX.format(vertices=lines))
    performance = perform({"right": default_hand("right")}, "open-close", 60, 3, (480, 360))
    Ms = np.zeros((60, 1, 3, 4))
    middle = performance.actors[0].vertices(0).mean(axis=0)
    for moment in range(60):
        turn = se3.exp(np.array([0.0, 0.0, 0.0, *(np.deg2rad(3.0 * moment) * np.array([0.6, 0.0, 0.8]))]))
        Ms[moment, 0] = turn[:3]
        Ms[moment, 0, :, 3] = middle + np.array([0.07 - 0.004 * moment, 0.0, -0.05])
    box = Actor("box", load_model(folder / "box.off"), Ms, (0.1, 0.3, 0.5))
    performance = replace(performance, actors=(*performance.actors, box))
    write_recording(performance, folder / "box", RecordingOptions(range(FRAMES)), save_npz_model)
    return load_sequence(folder / "box"), load_truth(folder / "box" / "truth.npz")


def follow(sequence: Sequence, frames: range = range(FRAMES)) -> Track:
    setup, start = start_tracking(sequence, TrackOptions(calibrate=False, cameras="cam0,cam1,cam2", use_depth=False))
    _, chunk = track_frames(sequence, setup, start, frames)
    return join_chunks(sequence, setup, [chunk])


def place_elsewhere(sequence: Sequence, folder: Path, T: np.ndarray | None) -> Sequence:
    """The recording in another folder, with the box placed elsewhere, or by nobody."""
    shutil.copytree(sequence.folder, folder)
    description = json.loads((sequence.folder / "sequence.json").read_text())
    description["objects"][0]["initial"] = {"T_world_object": T.tolist()} if T is not None else {}
    (folder / "sequence.json").write_text(json.dumps(description))
    return load_sequence(folder)


def test_a_box_is_followed_with_the_hand_that_it_hides(turning):
    sequence, truth = turning
    track = follow(sequence)
    assert track.setup.names == ("right", "box")
    assert track.hand_status[:, 0].tolist() == ["recovered", *["ok"] * (FRAMES - 1)]
    assert track.object_status[:, 0].tolist() == ["ok"] * FRAMES
    pairs = zip(truth.T_world_object[:, 0], track.T_world_object[:, 0], strict=True)
    apart = np.array([se3.log(se3.inverse(true) @ found) for true, found in pairs])
    assert 1000.0 * np.linalg.norm(apart[:, :3], axis=1).max() < 2.0
    assert np.rad2deg(np.linalg.norm(apart[:, 3:], axis=1)).max() < 4.0


def test_a_box_that_is_not_where_it_was_placed_is_lost(turning, tmp_path):
    sequence, truth = turning
    T = truth.T_world_object[0, 0].copy()
    T[:3, 3] += [0.0, -0.12, 0.0]
    track = follow(place_elsewhere(sequence, tmp_path / "moved", T), range(2))
    assert track.object_status[:, 0].tolist() == ["lost"] * 2
    assert track.hand_status[:, 0].tolist() == ["recovered", "ok"]


def test_an_object_that_nobody_placed_is_left_out_with_a_warning(turning, tmp_path, caplog):
    with caplog.at_level(logging.WARNING):
        track = follow(place_elsewhere(turning[0], tmp_path / "nowhere", None), range(1))
    assert track.setup.names == ("right",)
    assert "box: left out" in caplog.text
