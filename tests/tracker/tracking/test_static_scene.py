"""A table in the depth image, or named by the recording, carries what lies on it; a bare hand is no table."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import drawn_hand
from tracker.capture.frame import Frame
from tracker.capture.sequence import load_sequence, save_sequence_json
from tracker.capture.static_plane import StaticPlane
from tracker.errors import SequenceError
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.tracking.static_scene import find_plane_behind, see_static_scene

UP = np.array([0.0, -0.8, -0.6])
"""Of a table that the camera looks down to by 37 degrees."""


def hand_before(table_point: np.ndarray | None):
    """A drawn hand, and the depth image with a table behind it, m."""
    drawn = drawn_hand()
    depth = drawn.frame.depth
    assert depth is not None
    if table_point is not None:
        rows, columns = np.indices(depth.shape)
        K = drawn.camera.K
        rays = np.stack([(columns - K[0, 2]) / K[0, 0], (rows - K[1, 2]) / K[1, 1], np.ones(depth.shape)], axis=-1)
        facing = rays @ UP
        table = np.where(facing < -0.05, (table_point @ UP) / np.minimum(facing, -0.05), 0.0)
        table[(table < 0.0) | (table > 2.0)] = 0.0
        depth = np.where(depth > 0.0, depth, table).astype(np.float32)
    setup = TrackSetup(("right",), drawn.scene.models, "cam0", TrackOptions())
    return setup, Frame(0, "cam0", None, depth), drawn.camera, drawn.pose


def test_the_table_behind_a_hand_is_found_and_tells_which_way_is_down(recorded):
    under = np.array([0.0, 0.2, 0.5])
    setup, frame, camera, pose = hand_before(under)
    seen = see_static_scene(recorded.sequence, setup, frame, camera, pose)
    assert (seen.down_from, seen.planes_from) == ("plane", "depth")
    np.testing.assert_allclose(seen.down, -UP, atol=0.01)
    assert abs((np.array(seen.planes[0].point) - under) @ UP) < 0.002


def test_a_bare_hand_is_no_table_and_nothing_is_looked_for_that_nobody_wants(recorded):
    setup, frame, camera, pose = hand_before(None)
    assert find_plane_behind(setup, frame, camera, pose) is None
    assert see_static_scene(recorded.sequence, setup, frame, camera, pose).down_from == "camera"
    setup, frame, camera, pose = hand_before(np.array([0.0, 0.2, 0.5]))
    for wanted in ("none", "recording"):
        without = replace(setup, options=TrackOptions(static_scene=wanted))
        seen = see_static_scene(recorded.sequence, without, frame, camera, pose)
        assert (seen.planes, seen.planes_from, seen.down) == ((), "nobody", (0.0, 1.0, 0.0))


def test_a_plane_that_the_hand_reaches_through_is_none():
    setup, frame, camera, pose = hand_before(np.array([0.0, 0.0, 0.45]))
    assert find_plane_behind(setup, frame, camera, pose) is None


def test_what_the_recording_names_counts_before_what_is_found(recorded):
    wall = StaticPlane((0.0, 0.0, 1.0), (0.0, 0.0, -1.0))
    sequence = replace(recorded.sequence, gravity=(0.6, 0.8, 0.0), planes=(wall,))
    setup, frame, camera, pose = hand_before(np.array([0.0, 0.2, 0.5]))
    seen = see_static_scene(sequence, setup, frame, camera, pose)
    assert (seen.planes, seen.planes_from) == ((wall,), "recording")
    assert (seen.down, seen.down_from) == ((0.6, 0.8, 0.0), "recording")


def test_it_is_written_to_the_recording_and_to_the_setup_and_read_back(recorded, tmp_path):
    wall = StaticPlane((0.0, 0.0, 1.0), (0.0, 0.0, -1.0))
    named = replace(recorded.sequence, folder=tmp_path, gravity=(0.6, 0.8, 0.0), planes=(wall,))
    path = save_sequence_json(named)
    assert (load_sequence(tmp_path).gravity, load_sequence(tmp_path).planes) == (named.gravity, named.planes)
    for bad in ('"gravity": [0, 0, 0]', '"gravity": [1, 2]', '"planes": [{"point": [0, 0, 0]}]', '"planes": 3'):
        name = bad.partition(":")[0]
        path.write_text(path.read_text().replace(name, '"was"', 1).replace('"version"', bad + ', "version"', 1))
        with pytest.raises(SequenceError):
            load_sequence(tmp_path)
        save_sequence_json(named)
    setup, frame, camera, pose = hand_before(np.array([0.0, 0.2, 0.5]))
    whole = replace(setup, static_scene=see_static_scene(recorded.sequence, setup, frame, camera, pose))
    whole.save(tmp_path / "track")
    assert TrackSetup.load(tmp_path / "track").static_scene == whole.static_scene
    setup.save(tmp_path / "track")
    assert TrackSetup.load(tmp_path / "track").static_scene is None
