"""The hands of a whole recording, as the hand detector sees them, and their file.

The file is an `annotations.json` whose items have a `score` besides, and that says which images were looked at. Every
joint in it has the source `detector`, so what becomes a label of it stays known as the detector's.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from itertools import groupby
from pathlib import Path
from time import perf_counter

from tracker.capture.annotations import MAX_BYTES, Annotation, Annotations, parse_annotations
from tracker.capture.atomic_file import write_atomically
from tracker.capture.document import load_json
from tracker.capture.sequence import MAX_FRAMES
from tracker.capture.sequence import Sequence as Recording
from tracker.detection.image_hands import find_image_hands
from tracker.errors import AnnotationError, SequenceError
from tracker.landmarks import DetectedHand, HandDetector

Before = Mapping[str, Mapping[str, DetectedHand]]
"""What was found in the frame before, by camera and side."""

Key = tuple[int, str, str]
"""Frame, camera, hand."""


@dataclass(frozen=True, eq=False)
class RecordedHands:
    """Hands that were found.

    Attributes:
        cameras: Whose images were looked at.
        frames: That were looked at.
        hands: Those that were found.
        scores: 0 to 1, that there is a hand, by frame, camera and hand.
        seconds: Of each image, to find its hands, in the order they were looked at; not kept in the file.
    """

    cameras: tuple[str, ...]
    frames: range
    hands: Annotations
    scores: Mapping[Key, float]
    seconds: tuple[float, ...] = field(default=())

    def covers(self, frame: int, camera: str) -> bool:
        """Whether an image was looked at."""
        return camera in self.cameras and frame in self.frames

    def at(self, frame: int, camera: str) -> tuple[Annotation, ...]:
        """The hands of an image."""
        return self._by_image.get((frame, camera), ())

    @cached_property
    def _by_image(self) -> dict[tuple[int, str], tuple[Annotation, ...]]:
        images = groupby(self.hands.items, lambda item: (item.frame, item.camera))
        return {image: tuple(hands) for image, hands in images}

    def count_frames(self) -> dict[str, int]:
        """In how many frames each hand was found, in any view."""
        found = {(item.hand, item.frame) for item in self.hands.items}
        return {side: sum(hand == side for hand, _ in found) for side in ("right", "left")}

    def save(self, path: Path) -> None:
        """Write the file, whole or not at all."""
        document = self.hands.to_json()
        for item, entry in zip(self.hands.items, document["items"], strict=True):
            entry["score"] = self.scores[item.key]
        document["looked_at"] = {"cameras": list(self.cameras), "frames": [self.frames.start, self.frames.stop]}
        write_atomically(path, (json.dumps(document, separators=(",", ":")) + "\n").encode())


def choose_views(recording: Recording, wanted: Sequence[str] = ()) -> tuple[str, ...]:
    """Cameras whose images the detector can look at: those asked for, or all that have colour or infrared.

    Raises:
        SequenceError: There is none, or one that was asked for has depth alone.
    """
    views = [recording.camera(name) for name in dict.fromkeys(wanted)] or [c for c in recording.cameras if c.has_color]
    if blind := [camera.id for camera in views if not camera.has_color]:
        raise SequenceError(
            f"{recording.name}: the camera {blind[0]} has only depth images; the hand detector needs colour or "
            "infrared ones. Choose another view."
        )
    if not views:
        raise SequenceError(
            f"{recording.name}: has only depth images; the hand detector needs colour or infrared ones."
        )
    return tuple(camera.id for camera in views)


def detect_hands(
    recording: Recording,
    detector: HandDetector,
    cameras: Sequence[str],
    frames: range,
    before: Before,
    progress: Callable[[int], None] = lambda frame: None,
) -> tuple[RecordedHands, Before]:
    """Find the hands of some frames, followed from each to the next.

    Args:
        recording: A recording.
        detector: Finds hands in images.
        cameras: As `choose_views` gives them.
        frames: One after the other.
        before: What was found in the frame before these.
        progress: Told each frame that is done; may raise to stop.

    Returns:
        The hands, and those of the last frame, from which the next ones go on.
    """
    items, scores, seconds = [], {}, []
    latest = {name: dict(before.get(name, {})) for name in cameras}
    for number in frames:
        for name in cameras:
            frame, focal = recording.frame(number, name), float(recording.camera(name).K[0, 0])
            began = perf_counter()
            found = find_image_hands(detector, frame, focal, recording.hands, latest[name])
            seconds.append(perf_counter() - began)
            latest[name] = {hand.side: hand.detected for hand in found}
            for hand in found:
                items.append(hand.annotate(frame))
                scores[items[-1].key] = round(hand.score, 4)
        progress(number)
    return RecordedHands(tuple(cameras), frames, Annotations(tuple(items)), scores, tuple(seconds)), latest


def join_recorded_hands(parts: Iterable[RecordedHands]) -> RecordedHands:
    """Those of frames that follow each other."""
    parts = list(parts)
    frames = range(parts[0].frames.start, parts[-1].frames.stop)
    hands = Annotations(tuple(item for part in parts for item in part.hands.items))
    scores = {key: score for part in parts for key, score in part.scores.items()}
    return RecordedHands(parts[0].cameras, frames, hands, scores, tuple(s for part in parts for s in part.seconds))


def load_recorded_hands(path: Path) -> RecordedHands:
    """From what `RecordedHands.save` wrote, checked as if it were foreign."""
    node = load_json(path, MAX_BYTES, AnnotationError)
    hands = parse_annotations(node)
    scores = {}
    for item in node.get("items").items(len(hands.items)):
        key = item.get("frame").value, item.get("camera").value, item.get("hand").value
        scores[key] = item.get("score").number(0.0, 1.0)
    looked_at = node.get("looked_at")
    cameras = tuple(item.text(64) for item in looked_at.get("cameras").items(64))
    frames = [item.integer(0, MAX_FRAMES) for item in looked_at.get("frames").items(2)]
    if len(frames) != 2:
        looked_at.get("frames").fail("[first frame, last frame + 1]")
    return RecordedHands(cameras, range(*frames), hands, scores)
