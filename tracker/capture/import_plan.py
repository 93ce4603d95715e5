"""What an importer found in a folder, and what it means to make of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotations
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_question import ImportQuestion
from tracker.capture.listed_files import ListedFiles
from tracker.capture.recorded_object import RecordedObject
from tracker.capture.static_plane import StaticPlane

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class DepthSample:
    """Raw depth values of some frames.

    Attributes:
        frames: How many frames were looked at.
        empty_frames: How many of them hold no value at all.
        zero_share: Share of pixels without a value.
        saturated_share: Share of pixels at 65535.
        percentiles: Raw values at 1, 5, 50, 95, 99 % of the pixels that have one; empty when none has.
        largest: Largest raw value.
    """

    frames: int
    empty_frames: int
    zero_share: float
    saturated_share: float
    percentiles: tuple[float, ...]
    largest: int


@dataclass(frozen=True)
class StreamProbe:
    """What a look at every frame's header and at some frames' pixels gave.

    Attributes:
        count: Frames.
        size: (width, height) px of most frames, or None.
        types: Kind of image to how many frames are of it.
        problems: Sentences, each a reason to refuse.
        timestamps: (T,) s, or empty.
        fps: As the file says, or None.
        depth: Sampled values of depth images, or None.
    """

    count: int
    size: tuple[int, int] | None
    types: dict[str, int]
    problems: tuple[str, ...] = ()
    timestamps: Array = field(default_factory=lambda: np.zeros(0))
    fps: float | None = None
    depth: DepthSample | None = None


@dataclass(frozen=True)
class SourceImage:
    """One image to be stored.

    Attributes:
        source: Original name, as `ImageStream.name_of` gives it.
        data: The file's bytes, decoded once already and found whole.
        size: (width, height) px.
    """

    source: str
    data: bytes
    size: tuple[int, int]


class ImageStream(Protocol):
    """Images of one kind of one camera, in order."""

    @property
    def suffix(self) -> str:
        """Type of the stored files: `.png` or `.jpg`."""
        ...

    def name_of(self, index: int) -> str:
        """Original name of frame `index`, with `#n` for frame n of a video."""
        ...

    def probe(self, samples: int) -> StreamProbe:
        """Look at every frame's header and decode about `samples` frames."""
        ...

    def read(self) -> Iterator[SourceImage]:
        """Every image, decoded and verified; raises FrameError at the first bad one."""
        ...


@dataclass(frozen=True, eq=False)
class PlannedCamera:
    """A camera to be imported.

    Attributes:
        id: Its id in the recording.
        K: (3, 3) px, or None when it is not known.
        distortion: (n,) OpenCV.
        T_world_camera: (4, 4) m.
        color: Colour images, or None.
        depth: Depth images, or None.
        depth_scale: m per unit, or None when it is not known.
        calibrated_size: (width, height) px that K belongs to, or None when the source does not say.
        timestamps: (T,) s, or empty.
        gaps: Missing frames, as sentences.
    """

    id: str
    K: Array | None
    distortion: Array = field(default_factory=lambda: np.zeros(0))
    T_world_camera: Array = field(default_factory=lambda: np.eye(4))
    color: ImageStream | None = None
    depth: ImageStream | None = None
    depth_scale: float | None = None
    calibrated_size: tuple[int, int] | None = None
    timestamps: Array = field(default_factory=lambda: np.zeros(0))
    gaps: tuple[str, ...] = ()

    def streams(self) -> Iterator[tuple[str, ImageStream]]:
        """Its streams with their kind."""
        if self.color is not None:
            yield "color", self.color
        if self.depth is not None:
            yield "depth", self.depth


@dataclass(frozen=True, eq=False)
class ImportPlan:
    """A recording to be imported; may be incomplete, then `problems` says what is missing.

    Attributes:
        format: Name of the importer.
        name: For people.
        fps: Frames per second, or None when only the streams know.
        cameras: In order.
        frame_count: As the source declares, or None when it is what the streams hold.
        hands: Hands that are seen.
        objects: Objects that are handled.
        gravity: (3,) unit, which way things fall, world, where the source says it.
        planes: Tables, floors, walls that the source names.
        files: Other files to copy, target to source, both relative.
        annotations: Already in the source, or None.
        problems: Sentences, each a reason to refuse.
        warnings: Sentences for the report.
        questions: What has to be told, and what may be.
        takes: Names of the options that matter to it.
        left_out: Original names of frames that are not imported.
        unit_known: Whether positions of cameras are in metres already.
    """

    format: str
    name: str
    fps: float | None
    cameras: tuple[PlannedCamera, ...]
    frame_count: int | None = None
    hands: tuple[str, ...] = ("right",)
    objects: tuple[RecordedObject, ...] = ()
    gravity: tuple[float, float, float] | None = None
    planes: tuple[StaticPlane, ...] = ()
    files: dict[str, str] = field(default_factory=dict)
    annotations: Annotations | None = None
    problems: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    questions: tuple[ImportQuestion, ...] = ()
    takes: tuple[str, ...] = ()
    left_out: tuple[str, ...] = ()
    unit_known: bool = True


class Importer(Protocol):
    """One kind of recording."""

    @property
    def format(self) -> str:
        """Its name in commands and requests, and that of its module."""
        ...

    @property
    def turn(self) -> int:
        """Importers with smaller numbers are offered a folder first."""
        ...

    def recognises(self, files: ListedFiles) -> bool:
        """Whether the folder looks like this kind."""
        ...

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        """What would be imported; raises TrackerError when nothing can be said at all."""
        ...


def default_name(files: ListedFiles, options: ImportOptions) -> str:
    """The name that was given, or that of the folder."""
    name = options.name or files.root.name
    printable = "".join(c for c in name if c.isprintable()).strip()[:200].rstrip()
    return printable or "recording"
