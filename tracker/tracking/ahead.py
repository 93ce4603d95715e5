"""The next frame, read and looked at in a second thread while this one is fitted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from time import perf_counter

from tracker.capture.camera import Camera
from tracker.capture.frame import CameraFrame, Frame
from tracker.capture.sequence import Sequence
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings, find_sightings
from tracker.landmarks import DetectedHand


@dataclass(frozen=True)
class FrameRead:
    """A frame as it was read.

    Attributes:
        frame: As an ideal pinhole camera sees it.
        camera: That camera.
        sightings: What the detector saw with nothing expected; None where it did not look, or overlooked a hand.
        seconds: That reading took.
    """

    frame: Frame
    camera: Camera
    sightings: Sightings | None
    seconds: float

    @classmethod
    def of(cls, sequence: Sequence, setup: TrackSetup, index: int) -> FrameRead:
        """A frame that the detector has not looked at."""
        started = perf_counter()
        frame, camera = setup.read(sequence, index)
        return cls(frame, camera, None, perf_counter() - started)


@dataclass(frozen=True)
class Glance:
    """How the detector looks at a frame: the frame is the only thing else that its sightings depend on.

    Attributes:
        index: Of the frame.
        before: The hands that were seen in the frame before, by name.
        turns: In which the image is looked through for palms, quarters.
    """

    index: int
    before: Mapping[str, DetectedHand]
    turns: tuple[int, ...]

    def is_same(self, other: Glance) -> bool:
        return self.index == other.index and self.turns == other.turns and self.before is other.before


class FramesAhead:
    """Prepares one frame at a time; whoever then asks for another look than was guessed gets a frame not looked at."""

    def __init__(self, sequence: Sequence, setup: TrackSetup, stop: int, pool: ThreadPoolExecutor) -> None:
        self._sequence, self._setup, self._stop, self._pool = sequence, setup, stop, pool
        self._begun: tuple[Glance, Future[FrameRead]] | None = None

    def begin(self, glance: Glance) -> None:
        """Prepare a frame, if the run goes so far."""
        if glance.index < self._stop:
            self._begun = glance, self._pool.submit(self._prepare, glance)

    def take(self, glance: Glance) -> FrameRead:
        """The frame, waited for.

        Raises:
            FrameError: It cannot be read.
        """
        begun, self._begun = self._begun, None
        if begun is not None:
            read = begun[1].result()
            if begun[0].is_same(glance):
                return read
        return FrameRead.of(self._sequence, self._setup, glance.index)

    def _prepare(self, glance: Glance) -> FrameRead:
        read = FrameRead.of(self._sequence, self._setup, glance.index)
        names = self._setup.hand_names
        seen = find_sightings(
            self._setup.hand_detector, read.frame, read.camera, names, glance.before, turns=glance.turns
        )
        # Where a hand is overlooked, it counts where it was expected: nobody knows yet.
        is_whole = seen.is_looked_at and len(seen.hands) == len(names)
        return FrameRead(read.frame, read.camera, seen if is_whole else None, read.seconds)


@dataclass(frozen=True)
class ViewsRead:
    """A moment as it was read.

    Attributes:
        views: The frames of all views.
        seconds: That reading took.
    """

    views: list[CameraFrame]
    seconds: float

    @classmethod
    def of(cls, sequence: Sequence, setup: TrackSetup, index: int, threads: int) -> ViewsRead:
        started = perf_counter()
        views = setup.read_views(sequence, index, threads)
        return cls(views, perf_counter() - started)


class ViewsAhead:
    """Reads one moment of several views at a time. Where hands are looked for there depends on the fit before."""

    def __init__(self, sequence: Sequence, setup: TrackSetup, stop: int, pool: ThreadPoolExecutor) -> None:
        self._sequence, self._setup, self._stop, self._pool = sequence, setup, stop, pool
        self._begun: tuple[int, Future[ViewsRead]] | None = None

    def begin(self, index: int) -> None:
        """Read a moment, if the run goes so far."""
        if index < self._stop:
            self._begun = index, self._pool.submit(ViewsRead.of, self._sequence, self._setup, index, 1)

    def take(self, index: int) -> ViewsRead:
        """The moment, waited for.

        Raises:
            FrameError: It cannot be read.
        """
        begun, self._begun = self._begun, None
        if begun is not None and begun[0] == index:
            return begun[1].result()
        return ViewsRead.of(self._sequence, self._setup, index, self._setup.options.threads)


@contextmanager
def read_ahead(sequence: Sequence, setup: TrackSetup, stop: int) -> Iterator[FramesAhead | ViewsAhead | None]:
    """What prepares the frames before `stop`; None where the run has one thread or goes another way."""
    if setup.options.threads == 1 or setup.options.is_as_written:
        yield None
        return
    with ThreadPoolExecutor(1, thread_name_prefix="next frame") as pool:
        way = ViewsAhead if setup.view_ids else FramesAhead
        yield way(sequence, setup, stop, pool)
