"""What each camera saw against the fit and against the other cameras."""

from __future__ import annotations

import numpy as np
import pytest

from tests.tracker.search.test_place_in_views import joints, look_from
from tracker.errors import TrackingError
from tracker.tracking.view_errors import ViewErrors, measure_views

__all__ = ["joints"]

CAMERAS = [look_from(angle) for angle in (-0.6, 0.0, 0.6, 1.2)]
MOVED = 2
FRAMES = 6


@pytest.fixture
def marks(joints: np.ndarray) -> np.ndarray:
    """(T, C, 1, 21, 2) px: exact, but for one camera that is 12 px off."""
    seen = np.stack([camera.project(joints) for camera in CAMERAS])
    seen[MOVED, :, 0] += 12.0
    return np.tile(seen[None, :, None], (FRAMES, 1, 1, 1, 1)).astype(np.float32)


def measure(marks: np.ndarray, joints: np.ndarray, lost: int | None = None) -> ViewErrors:
    is_lost = np.zeros((FRAMES, 1), dtype=np.bool_)
    if lost is not None:
        is_lost[lost] = True
    return measure_views(CAMERAS, np.arange(FRAMES), marks, np.tile(joints, (FRAMES, 1, 1, 1)), is_lost)


def test_a_camera_that_moved_is_far_from_what_the_others_see_and_its_rays_weigh_least(marks, joints):
    errors = measure(marks, joints)
    np.testing.assert_allclose(errors.fit_px[:, MOVED, 0], 12.0, atol=1e-3)
    others = [number for number in range(len(CAMERAS)) if number != MOVED]
    np.testing.assert_allclose(errors.fit_px[:, others, 0], 0.0, atol=1e-3)
    np.testing.assert_allclose(errors.weight[:, others, 0], 1.0, atol=1e-6)
    assert np.all(errors.left_out_px[:, MOVED, 0] > 11.0)
    assert np.all(errors.left_out_px[:, others, 0] < errors.left_out_px[:, [MOVED], 0])
    assert np.all(errors.weight[:, MOVED, 0] < 0.6)
    assert np.all(errors.outvoted[:, MOVED, 0] == 1.0)
    assert np.all(errors.outvoted[:, others, 0] == 0.0)
    assert len(errors.doubts()) == 1 and errors.doubts()[0].startswith(CAMERAS[MOVED].id)
    assert errors.summary()[CAMERAS[MOVED].id]["fit_px"] == pytest.approx(12.0, abs=1e-3)


def test_a_lost_hand_has_no_error_of_the_fit_and_a_camera_that_saw_nothing_no_weight(marks, joints):
    marks[1, 0] = np.nan
    marks[3] = np.nan
    errors = measure(marks, joints, lost=2)
    assert np.isnan(errors.fit_px[2]).all()
    assert np.isnan(errors.weight[2]).all()
    assert np.isfinite(errors.left_out_px[2]).all(), "what the cameras saw is compared whatever the fit"
    assert np.isnan(errors.fit_px[1, 0, 0])
    assert errors.weight[1, 0, 0] == 0.0
    assert np.isnan(errors.left_out_px[3]).all()


def test_a_camera_that_hardly_ever_sees_the_hand_is_named(marks, joints):
    marks[:, 0] = np.nan
    (doubt,) = measure(marks, joints).doubts()
    assert doubt.startswith(f"{CAMERAS[0].id} saw a hand in 0 of {FRAMES} frames")


def test_errors_come_back_from_their_file(marks, joints, tmp_path):
    errors = measure(marks, joints)
    errors.save(tmp_path / "views.npz")
    back = ViewErrors.load(tmp_path / "views.npz")
    assert back.camera_ids.tolist() == [camera.id for camera in CAMERAS]
    for name in ("fit_px", "left_out_px", "outvoted", "weight"):
        np.testing.assert_array_equal(getattr(back, name), getattr(errors, name))
    (tmp_path / "views.npz").write_bytes(b"no archive")
    with pytest.raises(TrackingError):
        ViewErrors.load(tmp_path / "views.npz")


def test_a_camera_that_looks_every_other_frame_weighs_as_much_and_raises_no_doubt(joints):
    cameras = [look_from(angle) for angle in (-1.2, -0.6, 0.0, 0.6, 1.2, 1.8)]
    seen = np.tile(np.stack([camera.project(joints) for camera in cameras])[None, :, None], (FRAMES, 1, 1, 1, 1))
    for frame in range(FRAMES):
        seen[frame, 1 - frame % 2 :: 2] = np.nan
    fits, never_lost = np.tile(joints, (FRAMES, 1, 1, 1)), np.zeros((FRAMES, 1), dtype=np.bool_)
    errors = measure_views(cameras, np.arange(FRAMES), seen.astype(np.float32), fits, never_lost)
    assert np.isnan(errors.weight[0, 1::2, 0]).all() and np.isnan(errors.weight[1, ::2, 0]).all()
    assert all(about["weight"] == pytest.approx(1.0) for about in errors.summary().values())
    assert errors.doubts() == ()
    seen[:, 3] = np.nan
    blind = measure_views(cameras, np.arange(FRAMES), seen.astype(np.float32), fits, never_lost)
    assert blind.doubts()[0].startswith("cam")
    assert "saw a hand in 0 of 3 frames" in blind.doubts()[0]
