"""A camera is looked at before it is stored: its sizes, lens, depth and times, each oddity in one sentence."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tracker.capture.camera_check import pick_pictures, report_camera
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_findings import Findings
from tracker.capture.import_plan import DepthSample, PlannedCamera, StreamProbe
from tracker.capture.import_report import CameraReport

K = np.array([[600.0, 0.0, 319.5], [0.0, 600.0, 239.5], [0.0, 0.0, 1.0]])
SAMPLE = DepthSample(3, 0, 0.25, 0.0, (400.0, 450.0, 700.0, 900.0, 1000.0), 1000)
NO_TIMES = np.zeros(0)


def check(
    K: np.ndarray | None = K, sample: DepthSample | None = SAMPLE, times: np.ndarray = NO_TIMES, **changes
) -> tuple[CameraReport, Findings]:
    """One camera of 640x480 px with depth in mm."""
    found = Findings()
    camera = replace(PlannedCamera("cam0", K, depth_scale=0.001), **changes)
    probes = {"depth": StreamProbe(3, (640, 480), {"16-bit grey PNG": 3}, depth=sample)}
    return report_camera(camera, probes, times, found), found


def lens(**changes: float) -> np.ndarray:
    """K with `fx`, `fy`, `cx` or `cy` changed."""
    values = {"fx": 600.0, "fy": 600.0, "cx": 319.5, "cy": 239.5} | changes
    return np.array([[values["fx"], 0, values["cx"]], [0, values["fy"], values["cy"]], [0, 0, 1]])


def test_a_sound_camera_is_described_and_nothing_is_said_of_it() -> None:
    report, found = check()
    assert found == Findings()
    assert (report.width, report.height, report.color_frames, report.depth_frames) == (640, 480, 0, 3)
    assert report.image_types == {"depth: 16-bit grey PNG": 3} and report.timestamps is None
    assert report.depth is not None and report.depth.percentiles_m == pytest.approx((0.4, 0.45, 0.7, 0.9, 1.0))
    assert report.depth.nearest_m == pytest.approx(0.45), "median of the nearest tenth"
    lens = report.calibration
    assert lens is not None and lens.principal_offset == (0.0, 0.0) and lens.centre_m == (0.0, 0.0, 0.0)
    assert lens.field_of_view_deg == pytest.approx((56.14, 43.60), abs=0.01)


def test_without_an_image_that_can_be_read_there_is_no_size_and_no_lens() -> None:
    found = Findings()
    report = report_camera(PlannedCamera("cam0", K), {"color": StreamProbe(0, None, {})}, NO_TIMES, found)
    assert (report.width, report.height, report.calibration, report.depth) == (0, 0, None, None)
    assert found == Findings()


def test_colour_of_another_size_than_depth_is_refused_with_the_option_that_mends_it() -> None:
    found = Findings()
    probes = {"color": StreamProbe(3, (1280, 720), {}), "depth": StreamProbe(3, (640, 480), {}, depth=SAMPLE)}
    report_camera(PlannedCamera("cam0", None, depth_scale=0.001), probes, NO_TIMES, found)
    (problem,), (question,) = found.problems, found.questions
    assert problem.startswith("cam0: colour is 1280x720 px and depth 640x480 px; needed colour registered to depth")
    assert (question.field, question.problem, question.is_required) == ("color_pattern", problem, True)


@pytest.mark.parametrize(
    ("K", "said"),
    [
        (lens(cx=415), None),
        (lens(cx=416), r"(416, 239.5) px is far from the image's centre"),
        (lens(cy=480), r"(319.5, 480) px lies outside the image"),
        (lens(fx=629), None),
        (lens(fx=631), r"fx (631) and fy (600) differ by more than 5 %"),
        (lens(fx=2432, fy=2432), "sees 15 degrees across; are the focal lengths"),
        (lens(fx=149, fy=149), "sees 130 degrees across"),
    ],
)
def test_an_odd_lens_is_warned_of_once_and_only_beyond_its_limit(K: np.ndarray, said: str | None) -> None:
    _, found = check(K)
    assert not found.problems and len(found.warnings) == (said is not None)
    assert said is None or said in found.warnings[0]


def test_an_impossible_focal_length_asks_for_its_option_and_an_impossible_place_for_none() -> None:
    report, found = check(lens(fy=3))
    assert report.calibration is None and [question.field for question in found.questions] == ["fy"]
    assert found.questions[0].ask.startswith("3 px for an image of 640x480") and "cam0" not in found.questions[0].ask
    mirrored = np.diag([-1.0, 1.0, 1.0, 1.0])
    report, found = check(T_world_camera=mirrored)
    assert report.calibration is None and found.questions == []
    assert found.problems == ["cam0: T_world_camera: the upper left 3x3 mirrors; needed a rotation."]


def test_a_lens_of_another_image_size_is_refused_with_both_sizes() -> None:
    _, found = check(calibrated_size=(1280, 960))
    assert found.problems == ["cam0: is calibrated for 1280x960 px; its images are 640x480 px."]
    assert check(calibrated_size=(640, 480))[1] == Findings()


@pytest.mark.parametrize(
    ("sample", "scale", "said"),
    [
        (replace(SAMPLE, percentiles=(), largest=0), 0.001, "none of 3 depth images looked at holds a value"),
        (replace(SAMPLE, largest=255), 0.001, "never exceed 255: 8-bit depth in 16-bit files"),
        (SAMPLE, None, "0.001 puts the scene at 0.7 m, 0.000125 at 0.0875 m, 0.0002 at 0.14 m"),
        (SAMPLE, 0.0001, "the nearest thing at 0.045 m; needed 0.05 to 5 m"),
        (SAMPLE, 0.012, "the nearest thing at 5.4 m"),
    ],
)
def test_impossible_depth_is_refused_for_its_first_fault_alone(
    sample: DepthSample, scale: float | None, said: str
) -> None:
    _, found = check(sample=sample, depth_scale=scale)
    (problem,) = found.problems
    assert problem.startswith("cam0: ") and said in problem
    asks = [question.field for question in found.questions]
    assert asks == (["depth_scale"] if sample is SAMPLE else [])


@pytest.mark.parametrize("scale", [0.05 / 450, 5 / 450])
def test_the_nearest_thing_may_be_at_either_limit(scale: float) -> None:
    assert check(depth_scale=scale)[1].problems == []


def test_odd_depth_is_warned_of() -> None:
    _, found = check(sample=replace(SAMPLE, empty_frames=2, saturated_share=0.02))
    assert found.warnings == [
        "cam0: 2 of 3 depth images looked at are empty.",
        "cam0: 2% of the depth pixels are at 65535; 'no value' should be 0.",
    ]
    _, far = check(depth_scale=0.006)
    assert far.warnings == ["cam0: the scene lies at 4.2 m (median); is depth_scale 0.006 right?"]


def test_even_times_have_neither_jitter_nor_dropped_frames() -> None:
    report, found = check(times=np.arange(30) / 30)
    times = report.timestamps
    assert times is not None and times.monotonic and times.dropped == 0 and found == Findings()
    assert times.median_interval_s == pytest.approx(1 / 30) and times.jitter_s < 1e-12


def test_dropped_frames_are_counted_by_the_length_of_their_gaps() -> None:
    kept = np.delete(np.arange(30), [10, 20, 21])
    report, found = check(times=kept / 30)
    assert report.timestamps is not None and report.timestamps.dropped == 3
    assert found.warnings == ["cam0: 3 frames seem to have been dropped, first after frame 9."]
    _, one = check(times=np.delete(np.arange(30), 10) / 30)
    assert one.warnings == ["cam0: 1 frame seems to have been dropped, first after frame 9."]


@pytest.mark.parametrize("step", [0.0, -0.01])
def test_times_that_do_not_ascend_are_refused_at_the_frame_that_is_not_later(step: float) -> None:
    times = np.arange(10) / 30
    times[6] = times[5] + step
    report, found = check(times=times)
    assert found.problems == ["cam0: timestamps do not ascend at frame 6."]
    assert report.timestamps is not None and not report.timestamps.monotonic


def test_one_time_tells_nothing() -> None:
    assert check(times=np.zeros(1))[0].timestamps is None


@pytest.mark.parametrize(("count", "shown"), [(0, ""), (1, "0"), (2, "01"), (3, "012"), (9, "048"), (10, "059")])
def test_pictures_are_the_first_the_middle_and_the_last_each_once(tmp_path, count: int, shown: str) -> None:
    stream = ImageFiles(tmp_path, tuple(str(number) for number in range(count)), False)
    assert pick_pictures(stream.name_of, count) == tuple(shown)
