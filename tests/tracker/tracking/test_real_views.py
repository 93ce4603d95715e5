"""A real hand before two colour cameras, without any mark: it is found, and held in both views."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.sequence import Sequence, load_sequence
from tracker.fitting.options import TrackOptions
from tracker.inspection.frame_view import describe_frame, render_overlay
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import Track, join_chunks, load_track

pytestmark = pytest.mark.shared_data

FRAMES = range(16, 48)


@pytest.fixture(scope="module")
def two_cameras(shared_data: Path, tmp_path_factory: pytest.TempPathFactory) -> Sequence:
    folder = tmp_path_factory.mktemp("two_cameras") / "recording"
    run_import(
        shared_data / "two_camera_rgb", folder, "synced_videos", ImportOptions(hands=("right",), world_unit_m=0.04)
    )
    return load_sequence(folder)


def track(sequence: Sequence, cameras: str = "") -> Track:
    options = TrackOptions(first_frame=FRAMES.start, last_frame=FRAMES.stop - 1, calibrate=False, cameras=cameras)
    setup, state = start_tracking(sequence, options)
    state, chunk = track_frames(sequence, setup, state, FRAMES)
    return join_chunks(sequence, setup, [chunk])


def test_the_hand_is_found_in_the_first_frame_and_held_in_both_views(two_cameras, tmp_path):
    found = track(two_cameras)
    assert found.status[0] == "recovered"
    assert set(found.status[1:]) == {"ok"}
    inside = [camera.can_see(joints).mean() for joints in found.joints_3d for camera in two_cameras.cameras]
    assert np.mean(inside) > 0.95
    found.save(tmp_path)
    assert load_track(tmp_path).setup.view_ids == ("cam0", "cam1")


@pytest.mark.slow
def test_one_camera_alone_gives_the_same_pose_in_its_image(two_cameras):
    both, alone = track(two_cameras), track(two_cameras, "cam1")
    assert np.mean(alone.status != "lost") > 0.9
    apart = np.linalg.norm(both.joints_2d[:, 1] - alone.joints_2d[:, 1], axis=2)
    assert np.median(apart) < 8.0


@pytest.mark.slow
def test_what_people_look_at_of_such_a_track_are_rays_in_place_of_depth(two_cameras):
    found = track(two_cameras)
    shown = describe_frame(two_cameras, found.setup, found.pose[5], int(found.frame[5]))
    assert shown.correspondences["joints_right"].shape == (42, 2, 3)
    assert len(shown.cloud) == 0 and not shown.unknown.mask.any() and shown.detections == ()
    assert np.isnan(shown.surface_fit[0]).all()
    for camera in two_cameras.cameras:
        overlay = render_overlay(two_cameras, found.setup, found.pose[5], int(found.frame[5]), camera.id)
        assert 3000 < np.count_nonzero(overlay[..., 3]) < 60_000
