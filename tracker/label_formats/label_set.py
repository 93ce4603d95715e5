"""What passes between the studio and the formats: labels of recordings, and what was lost or found on the way."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotation, Annotations
from tracker.capture.sequence import Sequence
from tracker.errors import say_count
from tracker.label_formats.image_names import ImageNames

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class LabelSet:
    """Labels of one recording.

    Attributes:
        key: Id of the recording; in files of several recordings it tells them apart.
        sequence: The recording.
        names: Of its images.
        annotations: What people marked.
        track_joints: World positions from a track, (21, 3) m, NaN where unknown, by frame and hand; empty without one.
    """

    key: str
    sequence: Sequence
    names: ImageNames
    annotations: Annotations = field(default_factory=Annotations)
    track_joints: dict[tuple[int, str], Array] = field(default_factory=dict)


@dataclass(frozen=True)
class ExportedLabels:
    """Files of an export.

    Attributes:
        files: Content by relative name.
        items: Hands in images that were written.
        joints: Joints of them that are there.
        notes: What the format could not take, and where 3D positions came from, as sentences.
    """

    files: dict[str, bytes]
    items: int
    joints: int
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class ImportHints:
    """What a file of labels may not say.

    Attributes:
        hand: `right` or `left`, of files that know one hand only.
        camera: Id of the camera, of files that don't name one.
        pixel_centre: Coordinate of the centre of the top-left pixel in the file: 0 or 0.5; None takes the format's.
        joint_order: One of JOINT_ORDERS, of files that number the joints.
    """

    hand: str | None = None
    camera: str | None = None
    pixel_centre: float | None = None
    joint_order: str | None = None


@dataclass(frozen=True, eq=False)
class ImportedLabels:
    """What was found in files of labels.

    Attributes:
        annotations: By the recording's key.
        problems: Reasons to refuse all of it, as sentences.
        warnings: What was read otherwise than one may think.
    """

    annotations: dict[str, Annotations]
    problems: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


MAX_NOTES = 20
"""That are named; more are counted."""


class Notes:
    """Collects sentences; equal kinds are counted instead of repeated."""

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._examples: dict[str, list[str]] = {}

    def add(self, kind: str, example: str = "", count: int = 1) -> None:
        """Note that something of a kind happened.

        In the kind `{n}` becomes the number of times, and of `[one|many]` the word that fits it stays.
        """
        if count:
            self._counts[kind] += count
            examples = self._examples.setdefault(kind, [])
            if example and len(examples) < 5:
                examples.append(example)

    def sentences(self) -> tuple[str, ...]:
        """One for each kind."""
        told = []
        for kind, count in list(self._counts.items())[:MAX_NOTES]:
            examples = self._examples[kind]
            more = f" ({', '.join(examples)}{', ...' if count > len(examples) else ''})" if examples else ""
            fitting = re.sub(r"\[(.*?)\|(.*?)\]", r"\1" if count == 1 else r"\2", kind)
            told.append(f"{fitting.replace('{n}', str(count))}{more}.")
        if len(self._counts) > MAX_NOTES:
            told.append(f"{say_count(len(self._counts) - MAX_NOTES, 'further kind', 'further kinds')} of notes.")
        return tuple(told)


class ImportCollector:
    """Gathers annotations; two for one place are a problem, never one of them silently."""

    def __init__(self, sets: Iterable[LabelSet]) -> None:
        self.sets = {item.key: item for item in sets}
        self.problems, self.warnings = Notes(), Notes()
        self._found: dict[str, dict[tuple[int, str, str], Annotation]] = {key: {} for key in self.sets}

    def add(self, key: str, annotation: Annotation) -> None:
        """Take an annotation in; one without a single joint says nothing."""
        if not (annotation.points[:, 2] > 0).any() and not annotation.points[:, :2].any():
            self.warnings.add("{n} [hand|hands] without a single joint [was|were] left out")
            return
        own = self._found[key]
        place = f"the {annotation.hand} hand in frame {annotation.frame} of {annotation.camera}"
        if annotation.key in own:
            self.problems.add("{n} [place has|places have] two hands of the same side; say which is which", place)
            return
        own[annotation.key] = annotation

    def finish(self) -> ImportedLabels:
        """What was found."""
        return ImportedLabels(
            {key: Annotations(tuple(own.values())) for key, own in self._found.items()},
            self.problems.sentences(),
            self.warnings.sentences(),
        )


def count_joints(annotations: Iterable[Annotation]) -> int:
    """Joints that are there."""
    return sum(int((item.points[:, 2] > 0).sum()) for item in annotations)


def is_outside(points: Array) -> npt.NDArray[np.bool_]:
    """(21,) joints that somebody said are not in the image: absent, but not at (0, 0) where nobody has looked."""
    return (points[:, 2] == 0) & (points[:, :2] != 0).any(axis=1)


def note_flat_visibility(notes: Notes, annotations: Iterable[Annotation], name: str) -> None:
    """Losses of a format that knows only whether a joint is there."""
    for item in annotations:
        notes.add(
            f"{{n}} occluded [joint|joints]: {name} does not say what is occluded",
            count=int((item.points[:, 2] == 1).sum()),
        )
    note_outside(notes, annotations, name)


def note_outside(notes: Notes, annotations: Iterable[Annotation], name: str) -> None:
    """Losses of a format that has one word for outside the image and for not looked at."""
    for item in annotations:
        notes.add(
            f"{{n}} [joint|joints] marked as outside the image: {name} holds [it|them] like joints nobody looked at",
            count=int(is_outside(item.points).sum()),
        )
