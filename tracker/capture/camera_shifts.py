"""Cameras whose videos are out of step, shifted by whole frames while they are imported.

`cam1=+3`: a moment is 3 frames later in cam1's video than in the others, as a calibration tells it, so that frame n of
the new recording shows cam1's frame n + 3 beside the others' frame n. Frames that not all cameras have are left out;
labels go with their pictures.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import islice

from tracker.capture.annotations import Annotations
from tracker.capture.import_plan import ImageStream, ImportPlan, PlannedCamera, SourceImage, StreamProbe
from tracker.capture.sequence import TRUTH_FILE
from tracker.errors import ImportRefusedError, say_count


@dataclass(frozen=True)
class ShiftedStream:
    """Images of a stream without its first and its last ones.

    Attributes:
        stream: All images.
        first: How many are left out at the beginning.
        last: How many at the end.
    """

    stream: ImageStream
    first: int
    last: int

    @property
    def suffix(self) -> str:
        return self.stream.suffix

    def name_of(self, index: int) -> str:
        return self.stream.name_of(index + self.first)

    def probe(self, samples: int) -> StreamProbe:
        found = self.stream.probe(samples)
        count = found.count - self.first - self.last
        if count < 1:
            needed = f"is shifted by more than it has ({say_count(found.count, 'frame')})"
            return replace(found, count=0, problems=(*found.problems, f"{self.stream.name_of(0)}: {needed}."))
        times = found.timestamps[self.first : self.first + count]
        # Times of a shifted video begin at 0 again: its frames are of the moments of the others.
        return replace(found, count=count, timestamps=times - times[0] if len(times) else times)

    def read(self) -> Iterator[SourceImage]:
        """As the stream's; as many images as are left out at the end are held back."""
        held: deque[SourceImage] = deque()
        for image in islice(self.stream.read(), self.first, None):
            held.append(image)
            if len(held) > self.last:
                yield held.popleft()


def shift_plan(plan: ImportPlan, shifts: dict[str, int]) -> ImportPlan:
    """The plan with cameras shifted, cut to the moments that all have.

    Raises:
        ImportRefusedError: A camera is not there, all are shifted alike, or no moment is left.
    """
    known = [camera.id for camera in plan.cameras]
    if unknown := sorted(set(shifts) - set(known)):
        raise ImportRefusedError(f"There is no camera {unknown[0]!r} to shift; there are {', '.join(known)}.")
    each = {name: shifts.get(name, 0) for name in known}
    low, high = min(each.values()), max(each.values())
    if low == high:
        raise ImportRefusedError("All cameras would be shifted alike, so nothing would change. Shift some of them.")
    if plan.frame_count is not None and plan.frame_count <= high - low:
        apart = f"The cameras would be {say_count(high - low, 'frame')} apart"
        raise ImportRefusedError(f"{apart}, and the recording has {plan.frame_count}: no moment is left.")
    count = None if plan.frame_count is None else plan.frame_count - (high - low)
    annotations = _shift_labels(plan.annotations, {name: shift - low for name, shift in each.items()}, count)
    told = f"Shifted as given: {', '.join(f'{name} by {by:+d} frames' for name, by in each.items() if by)}."
    return replace(
        plan,
        cameras=tuple(_shift_camera(camera, each[camera.id] - low, high - each[camera.id]) for camera in plan.cameras),
        frame_count=count,
        annotations=annotations,
        objects=tuple(replace(item, T_world_object=None, joints={}) for item in plan.objects),
        files={target: source for target, source in plan.files.items() if target != TRUTH_FILE},
        warnings=(*plan.warnings, told, *_find_losses(plan, annotations)),
    )


def _find_losses(plan: ImportPlan, annotations: Annotations | None) -> list[str]:
    """What is known of the moments as they were, and does not go with the shifted cameras."""
    losses = []
    if plan.annotations and annotations and (gone := len(plan.annotations.items) - len(annotations.items)):
        are = say_count(gone, "label is", "labels are")
        losses.append(f"{are} left out, with the pictures that not all cameras have a moment for.")
    if any(item.T_world_object is not None or item.joints for item in plan.objects):
        losses.append("The places of objects in the first frame are left out, because another frame is first now.")
    if TRUTH_FILE in plan.files:
        losses.append(f"{TRUTH_FILE} is left out, because it belongs to the old frames.")
    return losses


def _shift_camera(camera: PlannedCamera, first: int, last: int) -> PlannedCamera:
    streams = {kind: ShiftedStream(stream, first, last) for kind, stream in camera.streams()}
    times = camera.timestamps[first : len(camera.timestamps) - last]
    return replace(camera, **streams, timestamps=times - times[0] if len(times) else times)


def _shift_labels(labels: Annotations | None, firsts: dict[str, int], count: int | None) -> Annotations | None:
    """Labels with their pictures: a camera's frame n is its frame n minus its first one now."""
    if labels is None or count is None:
        return None
    moved = [replace(item, frame=item.frame - firsts[item.camera]) for item in labels.items]
    return Annotations(tuple(item for item in moved if 0 <= item.frame < count))
