"""Cameras that are known come back from the corners of a board that was waved in front of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.calibration.filmed_board import BOARD, Filmed, film, measure_places
from tracker.calibration.board import Board
from tracker.calibration.calibrate import CalibrationOptions, calibrate_cameras
from tracker.calibration.lens import Lens
from tracker.calibration.sightings import Sightings
from tracker.errors import CalibrationError

OFFSETS = (0.0, 1.3777, -0.3123, 0.0051)
NEAR = CalibrationOptions(max_offset_s=1.5)


@pytest.fixture(scope="module")
def filmed() -> Filmed:
    """Four cameras out of step, half a minute at 30 frames a second, corners with 0.2 px of noise."""
    return film(4, OFFSETS, fps=30.0, seconds=30.0)


@pytest.fixture(scope="module")
def sightings(filmed: Filmed) -> list[Sightings]:
    return filmed.sight_all()


def cut(seen: Sightings, first: float, last: float) -> Sightings:
    """What a camera saw of the board between two times, s; the video stays as long as it was."""
    kept = (seen.seen_at >= first) & (seen.seen_at < last)
    return replace(seen, frames=seen.frames[kept], corners=seen.corners[kept])


@pytest.mark.slow
def test_unknown_lenses_places_and_offsets_come_back(filmed: Filmed, sightings: list[Sightings]) -> None:
    result = calibrate_cameras(sightings, BOARD, NEAR)
    metres, degrees = measure_places(result.cameras, filmed.cameras)
    assert metres.max() < 0.001 and degrees.max() < 0.05
    assert [offset.is_known for offset in result.offsets] == [True] * 4
    assert np.abs([offset.seconds - true for offset, true in zip(result.offsets, OFFSETS, strict=True)]).max() < 0.002
    assert result.offsets[1].frames == pytest.approx(30 * OFFSETS[1], abs=0.06)
    for found, true in zip(result.cameras, filmed.cameras, strict=True):
        assert found.K[0, 0] == pytest.approx(true.K[0, 0], rel=0.002)
    # Noise of 0.2 px in x and y is 0.28 px; a moment between two frames averages some of it away.
    assert 0.2 < result.left_out.rms < 0.3 and result.left_out.rms < 1.1 * result.fitted.rms
    assert result.other_cameras_residuals.rms < 0.4
    assert any("cam1: is out of step: it shows a moment 41.3" in warning for warning in result.warnings)


@pytest.mark.slow
def test_the_scale_is_the_boards(sightings: list[Sightings]) -> None:
    double = Board("charuco", 7, 5, 0.08, 0.06, "DICT_5X5_100")
    one, two = (calibrate_cameras([cut(s, 0, 8) for s in sightings[:2]], board, NEAR) for board in (BOARD, double))
    lengths = [np.linalg.norm(result.cameras[1].T_world_camera[:3, 3]) for result in (one, two)]
    assert lengths[1] == pytest.approx(2 * lengths[0], rel=0.02)


def test_known_lenses_stay_as_they_are_and_places_are_better(filmed: Filmed, sightings: list[Sightings]) -> None:
    lenses = {camera.id: Lens(camera.K, camera.distortion) for camera in filmed.cameras}
    short = [cut(seen, 0, 10) for seen in sightings]
    result = calibrate_cameras(short, BOARD, replace(NEAR, lenses=lenses))
    metres, degrees = measure_places(result.cameras, filmed.cameras)
    assert metres.max() < 0.0005 and degrees.max() < 0.02
    assert all(np.array_equal(found.K, true.K) for found, true in zip(result.cameras, filmed.cameras, strict=True))
    with pytest.raises(CalibrationError, match="cam2: no lens of this name was given"):
        calibrate_cameras(short, BOARD, replace(NEAR, lenses={k: lenses[k] for k in ("cam0", "cam1", "cam3")}))


@pytest.mark.slow
def test_videos_taken_for_synchronous_disagree_and_those_that_are_do_not() -> None:
    late = film(2, (0.0, 0.1), seconds=8.0).sight_all()
    blind = calibrate_cameras(late, BOARD, CalibrationOptions(find_offsets=False))
    assert blind.left_out.rms > 2.0 and any("(median) at moments that were left out" in w for w in blind.warnings)
    true = calibrate_cameras(late, BOARD, NEAR)
    assert true.left_out.rms < 0.4
    together = film(2, seconds=8.0).sight_all()
    result = calibrate_cameras(together, BOARD, NEAR)
    assert abs(result.offsets[1].seconds) < 0.002
    assert not any("out of step" in warning for warning in result.warnings)


@pytest.mark.slow
def test_a_camera_that_sees_no_board_with_the_first_is_reached_by_way_of_another(filmed: Filmed, sightings) -> None:
    chain = [
        cut(sightings[0], 0, 12),
        sightings[1],
        cut(sightings[2], 13 + OFFSETS[2], 30),
        cut(sightings[3], 13 + OFFSETS[3], 30),
    ]
    result = calibrate_cameras(chain, BOARD, NEAR)
    metres, _ = measure_places(result.cameras, filmed.cameras)
    assert metres.max() < 0.004
    assert abs(result.offsets[3].seconds - OFFSETS[3]) < 0.002


def test_boards_that_no_two_cameras_share_are_named_with_what_to_do(sightings: list[Sightings]) -> None:
    apart = [cut(sightings[0], 0, 10), cut(sightings[1], 0, 10), cut(sightings[2], 15, 20), cut(sightings[3], 15, 20)]
    with pytest.raises(
        CalibrationError, match=r"cam2, cam3: no board was seen at the same moment .* by cam0, cam1\. Hold"
    ):
        calibrate_cameras(apart, BOARD, NEAR)


def test_a_board_that_hardly_moves_tells_no_offset_and_that_is_said() -> None:
    filmed = film(2, seconds=8.0)
    still = [
        replace(seen, corners=np.repeat(seen.corners[:60:10], 40, axis=0)[: len(seen.frames)])
        for seen in filmed.sight_all()
    ]
    count = min(len(seen.corners) for seen in still)
    still = [replace(seen, frames=np.arange(count), corners=seen.corners[:count]) for seen in still]
    lenses = {camera.id: Lens(camera.K, camera.distortion) for camera in filmed.cameras}
    few = [replace(seen, corners=np.repeat(seen.corners[:1], count, axis=0)) for seen in still]
    result = calibrate_cameras(few, BOARD, CalibrationOptions(max_offset_s=1.0, lenses=lenses))
    assert not result.offsets[1].is_known and result.offsets[1].seconds == 0.0
    assert any("cam1: the board moved too little" in warning for warning in result.warnings)


def test_a_mirrored_camera_is_named_when_a_checkerboard_is_filmed() -> None:
    board = Board("checkerboard", 8, 5, 0.035)
    seen = film(3, seconds=8.0, board=board).sight_all()
    grid = seen[1].corners.reshape(-1, 4, 7, 2)
    whole = np.isfinite(grid).all(axis=(1, 2, 3))  # as the detector numbers a flipped picture: rows run backwards
    flipped = (grid[:, ::-1] * [-1, 1] + [seen[1].width - 1, 0]).reshape(seen[1].corners.shape)
    wrong = replace(seen[1], frames=seen[1].frames[whole], corners=flipped[whole])
    with pytest.raises(CalibrationError, match="cam1: is mirrored"):
        calibrate_cameras([seen[0], wrong, seen[2]], board, CalibrationOptions(max_offset_s=0.2))


def test_unequal_lengths_are_a_warning_or_without_offsets_a_refusal_and_a_stop_is_refused(sightings) -> None:
    def end(seen: Sightings, seconds: float) -> Sightings:
        kept = cut(seen, 0, seconds)
        return replace(kept, times=kept.times[kept.times < seconds])

    short = [end(sightings[0], 10), end(sightings[3], 9)]
    result = calibrate_cameras(short, BOARD, replace(NEAR, max_offset_s=0.1))
    assert any("cam3: its video is shorter (270 frames, 9.00 s)" in warning for warning in result.warnings)
    with pytest.raises(CalibrationError, match=r"cam3: its video has 270 frames .* cut the videos to one length"):
        calibrate_cameras(short, BOARD, CalibrationOptions(find_offsets=False))
    with pytest.raises(CalibrationError, match="cam3: stops in the middle: its video has 120 frames"):
        calibrate_cameras([short[0], end(sightings[3], 4)], BOARD, NEAR)


@pytest.mark.parametrize("count", [1, 17])
def test_too_few_and_too_many_cameras_are_refused(count: int, sightings: list[Sightings]) -> None:
    with pytest.raises(CalibrationError, match=f"{count} cameras; needed 2 to 16"):
        calibrate_cameras([sightings[0]] * count, BOARD)


def test_what_the_report_raises_ends_the_work(sightings: list[Sightings]) -> None:
    class Stopped(Exception):
        pass

    def stop(what: str, share: float) -> None:
        if what == "relating the cameras":
            raise Stopped

    with pytest.raises(Stopped):
        calibrate_cameras([cut(s, 0, 5) for s in sightings], BOARD, replace(NEAR, max_offset_s=0.0), stop)
