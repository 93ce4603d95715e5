"""What an import would store, reported before anything is stored."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field
from typing import Any

from tracker.capture.import_question import ImportQuestion
from tracker.capture.object_units import ObjectReport
from tracker.capture.sensor_presets import SensorFit
from tracker.errors import say_count


@dataclass(frozen=True)
class TimestampReport:
    """When the frames were taken.

    Attributes:
        monotonic: Each later than the one before.
        median_interval_s: Between neighbours.
        jitter_s: 95th percentile of the distance from the median interval.
        dropped: Frames that seem to be missing, from intervals of 1.5 times the median and more.
    """

    monotonic: bool
    median_interval_s: float
    jitter_s: float
    dropped: int


@dataclass(frozen=True)
class DepthReport:
    """Depth values of some frames.

    Attributes:
        sampled_frames: How many frames were looked at.
        empty_frames: How many of them hold no value.
        zero_share: Share of pixels without a value.
        saturated_share: Share of pixels at the largest value a file can hold.
        percentiles_m: At 1, 5, 50, 95 and 99 % of the pixels that have a value; empty without a scale or values.
        nearest_m: Median of the nearest tenth of them: where the nearest thing is; None without a scale or values.
    """

    sampled_frames: int
    empty_frames: int
    zero_share: float
    saturated_share: float
    percentiles_m: tuple[float, ...]
    nearest_m: float | None = None


@dataclass(frozen=True)
class CalibrationReport:
    """Is it a plausible camera?

    Attributes:
        field_of_view_deg: Horizontal and vertical.
        principal_offset: Principal point from the image's centre, as a share of width and height.
        rotation_error: Largest deviation of R^T R from the identity.
        distortion: How many coefficients.
        centre_m: Position in the world.
    """

    field_of_view_deg: tuple[float, float]
    principal_offset: tuple[float, float]
    rotation_error: float
    distortion: int
    centre_m: tuple[float, float, float]


@dataclass(frozen=True)
class CameraReport:
    """One camera of the recording.

    Attributes:
        id: Its id.
        width: px, 0 when no image could be read.
        height: px.
        color_frames: Colour images.
        depth_frames: Depth images.
        image_types: Kind of image to number of files.
        gaps: Missing frames, as sentences.
        timestamps: None when the source has none.
        depth: None without depth images.
        calibration: None when the camera is not known.
        pictures: Names of the first, the middle and the last image of each kind.
    """

    id: str
    width: int
    height: int
    color_frames: int
    depth_frames: int
    image_types: dict[str, int]
    gaps: tuple[str, ...] = ()
    timestamps: TimestampReport | None = None
    depth: DepthReport | None = None
    calibration: CalibrationReport | None = None
    pictures: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class ImportReport:
    """The whole report.

    Attributes:
        format: Importer, or empty when none fits.
        name: Of the recording.
        fps: Frames per second, or None when it is not known.
        frame_count: Frames that would be stored.
        cameras: One report each.
        hands: Hands that are seen.
        objects: Names of objects.
        object_sizes: What is known of the size of each.
        annotations: How many annotations come along.
        baselines_m: Distance of each pair of cameras, such as `cam0 - cam1`.
        problems: Reasons to refuse.
        warnings: Things to know; the import is possible.
        left_out: Original names of frames that are not imported.
        options: What was told about the recording.
        questions: What has to be told, and what may be: all of it at once.
        sensors: Kinds of depth cameras with images of this size, the likeliest first; their values are typical ones.
        takes: Names of the options that matter to this import.
    """

    format: str = ""
    name: str = ""
    fps: float | None = None
    frame_count: int = 0
    cameras: tuple[CameraReport, ...] = ()
    hands: tuple[str, ...] = ()
    objects: tuple[str, ...] = ()
    object_sizes: tuple[ObjectReport, ...] = ()
    annotations: int = 0
    baselines_m: dict[str, float] = field(default_factory=dict)
    problems: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    options: dict[str, Any] = field(default_factory=dict)
    questions: tuple[ImportQuestion, ...] = ()
    sensors: tuple[SensorFit, ...] = ()
    takes: tuple[str, ...] = ()

    @property
    def ok(self) -> bool:
        """Whether it can be imported."""
        return not self.problems

    @property
    def summary(self) -> tuple[str, ...]:
        """What is in it, in sentences."""
        return tuple(_summarise(self))

    def to_json(self) -> dict[str, Any]:
        """Plain values, with `ok` and `summary`."""
        return {"ok": self.ok, "summary": list(self.summary), **asdict(self)}


def _summarise(report: ImportReport) -> list[str]:
    if not report.cameras:
        return ["Nothing can be imported."]
    sentences = []
    cameras = say_count(len(report.cameras), "camera")
    length = f", {report.frame_count / report.fps:.1f} s at {report.fps:g} frames per second" if report.fps else ""
    sentences.append(f"{say_count(report.frame_count, 'frame')} of {cameras}{length}.")
    for camera in report.cameras:
        kinds = [f"{n} {k}" for n, k in ((camera.color_frames, "colour"), (camera.depth_frames, "depth")) if n]
        sentences.append(f"{camera.id}: {camera.width}x{camera.height} px, {' and '.join(kinds) or 'no'} images.")
        if camera.depth and camera.depth.percentiles_m:
            near, far = camera.depth.percentiles_m[0], camera.depth.percentiles_m[-1]
            if camera.depth.nearest_m is not None:
                sentences.append(f"{camera.id}: the nearest thing is {camera.depth.nearest_m:.2f} m away.")
            sentences.append(
                f"{camera.id}: depth from {near:.3f} to {far:.3f} m (1 to 99 %, {camera.depth.sampled_frames} frames "
                f"looked at), {camera.depth.zero_share:.0%} of the pixels without a value."
            )
    if report.baselines_m:
        low, high = min(report.baselines_m.values()), max(report.baselines_m.values())
        sentences.append(
            f"Cameras are {low:.3f} m apart." if low == high else f"Cameras are {low:.3f} to {high:.3f} m apart."
        )
    what = [*(f"{hand} hand" for hand in report.hands), *report.objects]
    sentences.append(f"Seen: {', '.join(what)}." if what else "No hands or objects are named.")
    if report.annotations:
        sentences.append(f"{say_count(report.annotations, 'annotated hand is', 'annotated hands are')} along.")
    return sentences
