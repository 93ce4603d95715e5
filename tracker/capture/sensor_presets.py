"""Typical depth cameras: what their makers' drivers report, for recordings that come without a calibration.

These are typical values of a kind of camera, not the calibration of anybody's own: units of one kind differ by about
1 % in focal length and by some pixels in the principal point. A calibration of one's own is always better.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from tracker.capture.import_options import ImportOptions
from tracker.errors import ImportRefusedError

SAME_SHAPE = 0.01
"""Images whose width over height differs by less than this share were scaled, not cut."""


@dataclass(frozen=True)
class SensorMode:
    """A size of the depth image and its typical camera, px."""

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float


@dataclass(frozen=True)
class SensorPreset:
    """A kind of depth camera.

    Attributes:
        name: On the command line and in requests.
        label: For people.
        modes: Sizes of its images; others of the same shape are scaled from them.
        depth_scales: m per unit: its own first, then what programs usually save instead.
        reach_m: Nearest and farthest distance it measures, as its maker says.
        source: Where the numbers come from.
        fps: Usual frame rate.
    """

    name: str
    label: str
    modes: tuple[SensorMode, ...]
    depth_scales: tuple[float, ...]
    reach_m: tuple[float, float]
    source: str
    fps: float = 30.0

    def find_mode(self, width: int, height: int) -> SensorMode | None:
        """Its camera for images of this size, scaled from a size of the same shape if need be; None when none fits."""
        for mode in self.modes:
            if (mode.width, mode.height) == (width, height):
                return mode
        shape = width / height
        for mode in self.modes:
            if abs(shape * mode.height / mode.width - 1) < SAME_SHAPE:
                sx, sy = width / mode.width, height / mode.height
                return SensorMode(
                    width,
                    height,
                    round(mode.fx * sx, 2),
                    round(mode.fy * sx, 2),
                    round((mode.cx + 0.5) * sx - 0.5, 2),
                    round((mode.cy + 0.5) * sy - 0.5, 2),
                )
        return None

    def find_scale(self, raw: tuple[float, ...]) -> float | None:
        """The unit of depth (m) that puts the raw values at 5 % and 95 % within its reach; its own without values."""
        if len(raw) < 5:
            return self.depth_scales[0]
        near, far = self.reach_m
        fits = [s for s in self.depth_scales if 0.8 * near <= raw[1] * s and raw[3] * s <= 1.1 * far]
        return fits[0] if fits else None


_PRINT_OUT = "the camera's own calibration, printed by the RealSense SDK for one unit"
_OPENNI = "the defaults of the OpenNI driver, which the ROS packages openni_launch and openni2_launch use"

SENSOR_PRESETS: tuple[SensorPreset, ...] = (
    SensorPreset(
        "kinect_v1",
        "Kinect v1 (Xbox 360), depth registered to colour",
        (SensorMode(640, 480, 525.0, 525.0, 319.5, 239.5),),
        (0.001,),
        (0.4, 4.0),
        _OPENNI,
    ),
    SensorPreset(
        "kinect_v2",
        "Kinect v2 (Xbox One)",
        (SensorMode(512, 424, 365.456, 365.456, 254.878, 205.395),),
        (0.001,),
        (0.5, 4.5),
        "the default depth camera of libfreenect2",
    ),
    SensorPreset(
        "azure_kinect_narrow",
        "Azure Kinect, narrow view",
        (SensorMode(640, 576, 503.93, 503.98, 332.06, 325.88),),
        (0.001,),
        (0.25, 5.46),
        "the factory calibration of one unit, printed by the Azure Kinect SDK",
    ),
    SensorPreset(
        "azure_kinect_wide",
        "Azure Kinect, wide view",
        (SensorMode(1024, 1024, 504.0, 504.0, 511.5, 511.5),),
        (0.001,),
        (0.25, 2.88),
        "the focal length of its narrow view, which the same chip and lens have",
        15.0,
    ),
    SensorPreset(
        "realsense_sr300",
        "RealSense SR300 or SR305",
        (SensorMode(640, 480, 475.07, 475.07, 315.94, 245.29),),
        (0.000125, 0.001),
        (0.2, 1.5),
        "the camera of the HANDS 2017 and First-Person Hand Action data sets",
    ),
    SensorPreset(
        "realsense_d405",
        "RealSense D405",
        (
            SensorMode(848, 480, 425.01, 425.01, 428.63, 241.71),
            SensorMode(1280, 720, 641.5, 641.5, 646.4, 362.3),
            SensorMode(640, 480, 385.0, 385.0, 320.0, 240.0),
        ),
        (0.0001,),
        (0.07, 0.5),
        _PRINT_OUT + " at 848x480, scaled to the other sizes",
    ),
    SensorPreset(
        "realsense_d435",
        "RealSense D435, D455: depth as the camera gives it",
        (
            SensorMode(640, 480, 382.6, 382.6, 319.0, 246.3),
            SensorMode(1280, 720, 637.6, 637.6, 638.3, 370.5),
            SensorMode(848, 480, 422.4, 422.4, 422.7, 246.8),
        ),
        (0.001,),
        (0.2, 10.0),
        _PRINT_OUT,
    ),
    SensorPreset(
        "realsense_d400_aligned",
        "RealSense D415, D435: depth aligned to colour",
        (
            SensorMode(640, 480, 613.8, 613.9, 317.1, 248.8),
            SensorMode(1280, 720, 920.7, 920.8, 635.6, 373.1),
        ),
        (0.001,),
        (0.2, 10.0),
        _PRINT_OUT,
    ),
    SensorPreset(
        "orbbec_astra",
        "Orbbec Astra",
        (SensorMode(640, 480, 570.34, 570.34, 319.5, 239.5),),
        (0.001,),
        (0.4, 8.0),
        "the default of the OpenNI driver that it shares with PrimeSense's cameras",
    ),
    SensorPreset(
        "orbbec_femto",
        "Orbbec Femto Bolt or Mega, narrow view",
        (SensorMode(640, 576, 503.93, 503.98, 332.06, 325.88),),
        (0.001,),
        (0.25, 5.46),
        "the Azure Kinect, whose depth module it has",
    ),
    SensorPreset(
        "primesense",
        "PrimeSense Carmine, Asus Xtion",
        (SensorMode(640, 480, 570.34, 570.34, 319.5, 239.5),),
        (0.001, 0.0001),
        (0.35, 3.5),
        _OPENNI,
    ),
)


def find_preset(name: str) -> SensorPreset:
    """The preset of this name."""
    for preset in SENSOR_PRESETS:
        if preset.name == name:
            return preset
    known = ", ".join(preset.name for preset in SENSOR_PRESETS)
    raise ImportRefusedError(f"The sensor preset {name!r} is not known; known: {known}.")


@dataclass(frozen=True)
class SensorFit:
    """A preset for the images at hand.

    Attributes:
        name: Of the preset.
        label: For people.
        source: Where its numbers come from.
        values: Option to value, for images of this size and depth of this range.
        is_guess: Whether the size and the range of depth suggest it before all others.
    """

    name: str
    label: str
    source: str
    values: dict[str, float]
    is_guess: bool = False


def fit_presets(size: tuple[int, int] | None, raw: tuple[float, ...]) -> tuple[SensorFit, ...]:
    """Presets that have images of this size (px), the likeliest first.

    The guess is the one with the shortest reach that holds the depth values, raw at 1, 5, 50, 95 and 99 %; there is
    none when no unit puts them within anybody's reach.
    """
    if size is None:
        return ()
    fits: list[tuple[bool, float, SensorFit]] = []
    for preset in SENSOR_PRESETS:
        mode = preset.find_mode(*size)
        if mode is None:
            continue
        scale = preset.find_scale(raw)
        values = {"fx": mode.fx, "fy": mode.fy, "cx": mode.cx, "cy": mode.cy, "fps": preset.fps}
        values["depth_scale"] = preset.depth_scales[0] if scale is None else scale
        width = preset.reach_m[1] - preset.reach_m[0]
        fits.append((scale is None, width, SensorFit(preset.name, preset.label, preset.source, values)))
    fits.sort(key=lambda item: item[:2])
    return tuple(
        replace(fit, is_guess=number == 0 and not is_out and len(raw) >= 5)
        for number, (is_out, _, fit) in enumerate(fits)
    )


def apply_preset(
    options: ImportOptions, size: tuple[int, int] | None, raw: tuple[float, ...], warnings: list[str]
) -> ImportOptions:
    """The options with a preset's values where nothing was told; a warning says which values are typical ones."""
    if options.preset is None:
        return options
    preset = find_preset(options.preset)
    mode = None if size is None else preset.find_mode(*size)
    if mode is None:
        sizes = ", ".join(f"{m.width}x{m.height}" for m in preset.modes)
        found = "no readable image" if size is None else f"images of {size[0]}x{size[1]} px"
        raise ImportRefusedError(
            f"The sensor preset {preset.name} has images of {sizes} px or of the same shape; found {found}. "
            "Choose another preset, or give fx, cx and cy."
        )
    typical = {"fx": mode.fx, "fy": mode.fy, "cx": mode.cx, "cy": mode.cy}
    typical["depth_scale"] = preset.find_scale(raw) or preset.depth_scales[0]
    untold = {name: value for name, value in typical.items() if getattr(options, name) is None}
    if options.fx is not None:
        untold.pop("fy", None)  # as fx, unless told
    filled = replace(options, **untold)
    used = [name for name, value in typical.items() if getattr(filled, name) == value]
    if used:
        warnings.append(
            f"{', '.join(used)} are typical values of {preset.label}, not this camera's calibration "
            f"(from {preset.source})."
        )
    return filled if filled.fps is not None else replace(filled, fps=preset.fps)
