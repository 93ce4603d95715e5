"""Is one camera of a recording plausible? Its images, times, depth and calibration."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from tracker.capture.calibration import check_distortion, check_image_size, check_intrinsics, check_rigid
from tracker.capture.import_findings import Findings
from tracker.capture.import_plan import DepthSample, PlannedCamera, StreamProbe
from tracker.capture.import_report import CalibrationReport, CameraReport, DepthReport, TimestampReport
from tracker.errors import TrackerError, say_count

Array = npt.NDArray[np.float64]

NEAREST_M, FARTHEST_M = 0.05, 5.0
"""When the median of the nearest tenth of the depth is outside, the unit is wrong; no hand is captured there."""

USUAL_M = (0.1, 4.0)
"""Median depth of a scene with hands, m; outside of this the unit may be wrong."""


def report_camera(camera: PlannedCamera, probes: dict[str, StreamProbe], times: Array, found: Findings) -> CameraReport:
    """Report on one camera; what is wrong, odd or has to be told goes to the findings."""
    seen = {kind: probe.size for kind, probe in probes.items() if probe.size is not None}
    size = next(iter(seen.values()), (0, 0))
    if len(set(seen.values())) > 1:
        color, of_depth = (f"{seen[kind][0]}x{seen[kind][1]} px" for kind in ("color", "depth"))
        found.refuse(
            f"{camera.id}: colour is {color} and depth {of_depth}; needed colour registered to depth, pixel by pixel. "
            "Register them, or set color_pattern to 'none'.",
            "color_pattern",
            f"Colour is {color} and depth {of_depth}. Register them, or import depth alone.",
        )
    calibration = _check_camera(camera, size, found) if size != (0, 0) else None
    types = {f"{kind}: {name}": count for kind, probe in probes.items() for name, count in probe.types.items()}
    depth = _report_depth(camera, probes["depth"].depth, found) if "depth" in probes else None
    return CameraReport(
        id=camera.id,
        width=size[0],
        height=size[1],
        color_frames=probes["color"].count if "color" in probes else 0,
        depth_frames=probes["depth"].count if "depth" in probes else 0,
        image_types=types,
        gaps=camera.gaps,
        timestamps=_report_times(camera.id, times, found),
        depth=depth,
        calibration=calibration,
        pictures={kind: pick_pictures(stream.name_of, probes[kind].count) for kind, stream in camera.streams()},
    )


def pick_pictures(name_of: Callable[[int], str], count: int) -> tuple[str, ...]:
    """Names of the first, the middle and the last image."""
    return tuple(name_of(index) for index in sorted({0, count // 2, count - 1})) if count else ()


def _check_camera(camera: PlannedCamera, size: tuple[int, int], found: Findings) -> CalibrationReport | None:
    width, height = size
    K = camera.K
    if K is None:
        return None
    checks: tuple[Callable[[], None], ...] = (
        lambda: check_image_size(camera.id, width, height),
        lambda: check_intrinsics(camera.id, K, width, height),
        lambda: check_distortion(camera.id, camera.distortion),
        lambda: check_rigid(f"{camera.id}: T_world_camera", camera.T_world_camera),
    )
    for check in checks:
        try:
            check()
        except TrackerError as fault:
            return _refuse_calibration(str(fault), found)
    if camera.calibrated_size is not None and camera.calibrated_size != size:
        was = camera.calibrated_size
        found.refuse(f"{camera.id}: is calibrated for {was[0]}x{was[1]} px; its images are {width}x{height} px.")
    offset = (float(K[0, 2] / (width - 1) - 0.5), float(K[1, 2] / (height - 1) - 0.5))
    if max(map(abs, offset)) > 0.5:
        found.warn(f"{camera.id}: the principal point ({K[0, 2]:g}, {K[1, 2]:g}) px lies outside the image.")
    elif max(map(abs, offset)) > 0.15:
        found.warn(f"{camera.id}: the principal point ({K[0, 2]:g}, {K[1, 2]:g}) px is far from the image's centre.")
    if abs(K[0, 0] / K[1, 1] - 1) > 0.05:
        found.warn(f"{camera.id}: fx ({K[0, 0]:g}) and fy ({K[1, 1]:g}) differ by more than 5 %.")
    fov = tuple(float(np.degrees(2 * np.arctan(n / (2 * f)))) for n, f in ((width, K[0, 0]), (height, K[1, 1])))
    if not 15 <= fov[0] <= 130:
        found.warn(f"{camera.id}: sees {fov[0]:.0f} degrees across; are the focal lengths those of this image size?")
    R, centre = camera.T_world_camera[:3, :3], camera.T_world_camera[:3, 3]
    return CalibrationReport(
        field_of_view_deg=(fov[0], fov[1]),
        principal_offset=offset,
        rotation_error=float(np.abs(R.T @ R - np.eye(3)).max()),
        distortion=int(camera.distortion.size),
        centre_m=(float(centre[0]), float(centre[1]), float(centre[2])),
    )


def _refuse_calibration(text: str, found: Findings) -> None:
    """A focal length that cannot be right can be told anew."""
    option = next((name for name in ("fx", "fy") if f": {name} is " in text), "")
    found.refuse(text, option, text.partition(f": {option} is ")[2])


def _report_depth(camera: PlannedCamera, sample: DepthSample | None, found: Findings) -> DepthReport | None:
    if sample is None:
        return None
    _check_depth(camera, sample, found)
    if sample.empty_frames and sample.percentiles:
        found.warn(f"{camera.id}: {sample.empty_frames} of {sample.frames} depth images looked at are empty.")
    if sample.saturated_share > 0.01:
        share = f"{sample.saturated_share:.0%}"
        found.warn(f"{camera.id}: {share} of the depth pixels are at 65535; 'no value' should be 0.")
    metres = tuple(value * camera.depth_scale for value in sample.percentiles) if camera.depth_scale else ()
    return DepthReport(
        sampled_frames=sample.frames,
        empty_frames=sample.empty_frames,
        zero_share=sample.zero_share,
        saturated_share=sample.saturated_share,
        percentiles_m=metres,
        nearest_m=metres[1] if metres else None,
    )


def _check_depth(camera: PlannedCamera, sample: DepthSample, found: Findings) -> None:
    """The first thing that is wrong or odd about the values and their unit."""
    id, scale = camera.id, camera.depth_scale
    if not sample.percentiles:
        return found.refuse(f"{id}: none of {sample.frames} depth images looked at holds a value; all pixels are 0.")
    if sample.largest <= 255:
        return found.refuse(
            f"{id}: depth values never exceed {sample.largest}: 8-bit depth in 16-bit files; export the raw depth."
        )
    raw_near, raw = sample.percentiles[1:3]
    if scale is None:
        where = (
            f"0.001 puts the scene at {raw * 0.001:.3g} m, 0.000125 at {raw * 0.000125:.3g} m, "
            f"0.0002 at {raw * 0.0002:.3g} m (median)."
        )
        text = f"{id}: the unit of depth is not known. Give depth_scale, metres per unit: {where}"
        return found.refuse(text, "depth_scale", f"Metres per unit of the depth images: {where}")
    nearest, middle = raw_near * scale, raw * scale
    if not NEAREST_M <= nearest <= FARTHEST_M:
        return found.refuse(
            f"{id}: with depth_scale {scale:g} the scene lies at {middle:.3g} m (median) and the nearest thing "
            f"at {nearest:.3g} m; needed {NEAREST_M:g} to {FARTHEST_M:g} m, where hands are captured. With 0.001 "
            f"(millimetres) it would lie at {raw * 0.001:.3g} m.",
            "depth_scale",
            f"Puts the nearest thing at {nearest:.3g} m; needed {NEAREST_M:g} to {FARTHEST_M:g} m. "
            f"0.001 (millimetres) puts it at {raw_near * 0.001:.3g} m.",
        )
    if not USUAL_M[0] <= middle <= USUAL_M[1]:
        found.warn(f"{id}: the scene lies at {middle:.3g} m (median); is depth_scale {scale:g} right?")
    return None


def _report_times(camera: str, times: Array, found: Findings) -> TimestampReport | None:
    if len(times) < 2:
        return None
    intervals = np.diff(times)
    median = float(np.median(intervals))
    monotonic = bool((intervals > 0).all())
    if not monotonic:
        found.refuse(f"{camera}: timestamps do not ascend at frame {int(np.flatnonzero(intervals <= 0)[0]) + 1}.")
        return TimestampReport(False, median, float(np.ptp(intervals)), 0)
    jitter = float(np.percentile(np.abs(intervals - median), 95))
    lost = np.maximum(np.rint(intervals / median) - 1, 0)[intervals > 1.5 * median]
    dropped = int(lost.sum())
    if dropped:
        first = int(np.flatnonzero(intervals > 1.5 * median)[0])
        found.warn(
            f"{camera}: {say_count(dropped, 'frame seems', 'frames seem')} to have been dropped, "
            f"first after frame {first}."
        )
    return TimestampReport(True, median, jitter, dropped)
