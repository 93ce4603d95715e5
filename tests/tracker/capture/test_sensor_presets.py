"""Typical depth cameras: their numbers are possible, are scaled with the image, and are never taken for one's own."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.capture.calibration import check_image_size, check_intrinsics
from tracker.capture.import_options import ImportOptions
from tracker.capture.sensor_presets import SENSOR_PRESETS, SensorPreset, apply_preset, find_preset, fit_presets
from tracker.errors import ImportRefusedError

every_preset = pytest.mark.parametrize("preset", SENSOR_PRESETS, ids=lambda preset: preset.name)
KINECT = find_preset("kinect_v1")


def depths(preset: SensorPreset) -> tuple[float, ...]:
    """Raw values, in the preset's own unit, of a scene in the middle of its reach at 1, 5, 50, 95 and 99 %."""
    near, far = preset.reach_m
    return tuple((near + share * (far - near)) / preset.depth_scales[0] for share in (0.3, 0.4, 0.5, 0.6, 0.7))


@every_preset
def test_every_mode_is_a_possible_camera_and_says_where_it_is_from(preset: SensorPreset) -> None:
    assert find_preset(preset.name) is preset and preset.source and preset.reach_m[0] < preset.reach_m[1]
    for mode in preset.modes:
        check_image_size(preset.name, mode.width, mode.height)
        K = np.array([[mode.fx, 0, mode.cx], [0, mode.fy, mode.cy], [0, 0, 1]])
        check_intrinsics(preset.name, K, mode.width, mode.height)
        assert preset.find_mode(mode.width, mode.height) is mode


@given(st.sampled_from(SENSOR_PRESETS), st.sampled_from([0.5, 1.5, 2.0]))
def test_a_scaled_image_has_a_camera_with_the_same_angles_of_view(preset: SensorPreset, scale: float) -> None:
    mode = preset.modes[0]
    width, height = int(mode.width * scale), int(mode.height * scale)
    scaled = preset.find_mode(width, height)
    assert scaled is not None
    if scaled in preset.modes:
        return
    assert scaled.fx / width == pytest.approx(mode.fx / mode.width, rel=1e-4)
    assert (scaled.cx + 0.5) / width == pytest.approx((mode.cx + 0.5) / mode.width, abs=1e-4), "pixel corners scale"


def test_an_image_of_another_shape_has_no_camera() -> None:
    assert KINECT.find_mode(640, 400) is None
    with pytest.raises(ImportRefusedError, match="found images of 640x400 px"):
        apply_preset(ImportOptions(preset="kinect_v1"), (640, 400), (), [])
    with pytest.raises(ImportRefusedError, match="no readable image"):
        apply_preset(ImportOptions(preset="kinect_v1"), None, (), [])


@every_preset
def test_the_unit_of_depth_is_one_that_puts_the_scene_within_reach(preset: SensorPreset) -> None:
    assert preset.find_scale(()) == preset.depth_scales[0] == preset.find_scale(depths(preset))
    assert preset.find_scale((1e9,) * 5) is None


def test_the_guess_is_the_kind_of_camera_with_the_shortest_reach_that_holds_the_depth() -> None:
    raw = depths(KINECT)
    fits = fit_presets((640, 480), raw)
    assert [fit.is_guess for fit in fits] == [True] + [False] * (len(fits) - 1)
    reach = {preset.name: preset.reach_m[1] - preset.reach_m[0] for preset in SENSOR_PRESETS}
    holding = [fit for fit in fits if find_preset(fit.name).find_scale(raw) is not None]
    assert fits[0].name == min(holding, key=lambda fit: reach[fit.name]).name
    assert fit_presets(None, raw) == () and not any(fit.is_guess for fit in fit_presets((640, 480), ()))
    assert not any(fit.is_guess for fit in fit_presets((640, 480), (1e9,) * 5)), "out of everybody's reach"


def test_what_was_told_stays_and_the_rest_is_said_to_be_typical() -> None:
    warnings: list[str] = []
    told = ImportOptions(preset="kinect_v1", fx=500.0, cx=300.0, fps=15.0)
    found = apply_preset(told, (640, 480), (), warnings)
    assert (found.fx, found.fy, found.cx, found.fps) == (500.0, None, 300.0, 15.0), "fy is as fx, which was told"
    assert found.cy == KINECT.modes[0].cy
    (warning,) = warnings
    assert warning.startswith("cy, depth_scale are typical values of Kinect v1") and "not this camera's" in warning
    assert apply_preset(ImportOptions(), (640, 480), (), []) == ImportOptions()
    assert apply_preset(ImportOptions(preset="kinect_v1"), (640, 480), (), []).fps == KINECT.fps


def test_an_unknown_preset_is_refused_with_those_that_are_known() -> None:
    with pytest.raises(ImportRefusedError, match="known: kinect_v1"):
        find_preset("kinect_v9")
