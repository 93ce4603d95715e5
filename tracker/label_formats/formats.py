"""Every format of labels: what it holds, its writer and its reader."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from tracker.capture.source_choice import ALL, count_origins, describe_origin, is_independent, keep_joints, say_left_out
from tracker.errors import AnnotationError, reading
from tracker.label_formats.coco_keypoints import read_coco_keypoints, write_coco_keypoints
from tracker.label_formats.coco_wholebody import read_coco_wholebody, write_coco_wholebody
from tracker.label_formats.deeplabcut import read_deeplabcut, write_deeplabcut
from tracker.label_formats.freihand import read_freihand, write_freihand
from tracker.label_formats.handloom_json import read_handloom, write_handloom
from tracker.label_formats.interhand import read_interhand, write_interhand
from tracker.label_formats.label_set import ExportedLabels, ImportedLabels, ImportHints, LabelSet
from tracker.label_formats.t16_text import read_t16, write_t16


@dataclass(frozen=True)
class LabelFormat:
    """A format.

    Attributes:
        name: In addresses and on the command line.
        title: For people.
        holds: What of the labels it takes.
        loses: What it cannot take, as sentences.
        file: Name of an export; `.zip` when it is several files.
        several: Whether one export can hold several recordings.
        needs_3d: Whether it holds 3D joints and nothing else.
        carries_sources: Whether it says of each joint where it came from.
    """

    name: str
    title: str
    holds: str
    loses: tuple[str, ...]
    file: str
    write: Callable[[list[LabelSet]], ExportedLabels]
    read: Callable[[dict[str, bytes], list[LabelSet], ImportHints], ImportedLabels]
    several: bool = False
    needs_3d: bool = False
    carries_sources: bool = False


_OUTSIDE = "joints outside the image become joints that nobody looked at"
_OCCLUDED = "occluded joints become visible ones"
_FORMATS = (
    LabelFormat(
        "annotations",
        "Handloom (annotations.json)",
        "everything",
        (),
        "annotations.json",
        write_handloom,
        read_handloom,
        carries_sources=True,
    ),
    LabelFormat(
        "coco_keypoints",
        "COCO keypoints",
        "2D joints, occlusion, side, all cameras",
        (_OUTSIDE,),
        "coco_keypoints.json",
        write_coco_keypoints,
        read_coco_keypoints,
        several=True,
        carries_sources=True,
    ),
    LabelFormat(
        "coco_wholebody",
        "COCO-WholeBody hands",
        "2D joints, occlusion, side, all cameras",
        (_OUTSIDE,),
        "coco_wholebody.json",
        write_coco_wholebody,
        read_coco_wholebody,
        several=True,
        carries_sources=True,
    ),
    LabelFormat(
        "freihand",
        "FreiHAND",
        "3D joints of right hands that are known whole",
        (
            "left hands are left out",
            "hands without all 21 joints in 3D are left out",
            _OCCLUDED,
            "lens distortion is lost",
        ),
        "freihand.zip",
        write_freihand,
        read_freihand,
        needs_3d=True,
    ),
    LabelFormat(
        "interhand",
        "InterHand2.6M",
        "3D joints of both hands, calibrated cameras",
        ("joints that are not known in 3D are left out", _OCCLUDED, "lens distortion is lost"),
        "interhand.zip",
        write_interhand,
        read_interhand,
        needs_3d=True,
    ),
    LabelFormat(
        "deeplabcut",
        "DeepLabCut (CSV)",
        "2D joints, side, a table for each camera",
        (_OCCLUDED, _OUTSIDE),
        "deeplabcut.zip",
        write_deeplabcut,
        read_deeplabcut,
    ),
    LabelFormat(
        "t16",
        "T16 (joints_2D_GT)",
        "2D joints in whole pixels, side, all cameras",
        (_OCCLUDED, _OUTSIDE, "positions are rounded to whole pixels", "joints in row or column 0 are left out"),
        "joints_2D_GT.zip",
        write_t16,
        read_t16,
    ),
)
LABEL_FORMATS: dict[str, LabelFormat] = {item.name: item for item in _FORMATS}


def find_label_format(name: str) -> LabelFormat:
    """The format of this name."""
    if name not in LABEL_FORMATS:
        raise AnnotationError(f"There is no format of labels {name!r}; there are {', '.join(LABEL_FORMATS)}.")
    return LABEL_FORMATS[name]


def export_labels(name: str, sets: list[LabelSet], sources: Sequence[str] = (ALL,)) -> ExportedLabels:
    """Files of the labels, with the joints that came from one of `sources` (SOURCE_CHOICES).

    Raises when there is nothing that the format could hold.
    """
    format_ = find_label_format(name)
    if len(sets) != 1 and not format_.several:
        several = ", ".join(item.name for item in _FORMATS if item.several)
        raise AnnotationError(f"{format_.title} holds one recording a file; {several} hold several.")
    kept = [keep_joints(item.annotations, sources) for item in sets]
    left_out = say_left_out(pair for _, gone in kept for pair in gone)
    chosen = [replace(item, annotations=found) for item, (found, _) in zip(sets, kept, strict=True)]
    made = format_.write(chosen)
    notes = [left_out, "" if format_.carries_sources else _note_sources(chosen, format_.title)]
    return replace(made, notes=(*(note for note in notes if note), *made.notes))


def _note_sources(sets: list[LabelSet], title: str) -> str:
    """That a format does not say where joints came from, where that matters."""
    words = count_origins(
        describe_origin(item.sources, joint)
        for one in sets
        for item in one.annotations.items
        for joint, source in enumerate(item.sources or ())
        if item.points[joint, 2] > 0 and not is_independent(source)
    )
    told = ", ".join(f"{count} {word}" for word, count in words)
    return f"{title} does not say where joints came from: {told}." if words else ""


def import_labels(
    name: str | None, files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints | None = None
) -> tuple[str, ImportedLabels]:
    """The format and what was found; raises when the files cannot be read at all."""
    first = next(iter(files), "files of labels")
    with reading(AnnotationError, first, f"labels as {', '.join(LABEL_FORMATS)} write them"):
        format_ = find_label_format(name or recognise_labels(files))
    if len(sets) != 1 and not format_.several:
        raise AnnotationError(f"{format_.title} holds one recording a file; name the recording.")
    hints = hints or ImportHints()
    if hints.hand not in (None, "right", "left"):
        raise AnnotationError(f"The option hand is {str(hints.hand)[:40]!r}; needed right or left.")
    if hints.pixel_centre not in (None, 0.0, 0.5):
        raise AnnotationError(f"The option pixel_centre is {hints.pixel_centre}; needed 0 or 0.5.")
    with reading(AnnotationError, first, f"labels as {format_.title} writes them"):
        return format_.name, format_.read(files, sets, hints)


_NAMES = {
    "interhand": re.compile(r"_joint_3d\.json\Z"),
    "freihand": re.compile(r"_xyz\.json\Z"),
    "deeplabcut": re.compile(r"(?ai)\.csv\Z"),
    "t16": re.compile("joints_2D_GT/"),
}
"""How files of a format are called."""

_WORDS = (
    ("coco_wholebody", (b'"lefthand_kpts"',)),
    ("coco_wholebody", (b'"righthand_kpts"',)),
    ("coco_keypoints", (b'"categories"', b'"annotations"')),
    ("annotations", (b'"items"', b'"joints"')),
)
"""What a single file of a format holds; the first that fits, since COCO's own hold all of it."""


def recognise_labels(files: dict[str, bytes]) -> str:
    """The format of files, from their names and first words; raises when it is none or could be several."""
    for format, pattern in _NAMES.items():
        if any(pattern.search(name) for name in files):
            return format
    data = next(iter(files.values())) if len(files) == 1 else b""
    for format, words in _WORDS:
        if all(word in data for word in words):
            return format
    raise AnnotationError(
        f"The labels were not recognised ({', '.join(sorted(files)[:5])}); say the format: {', '.join(LABEL_FORMATS)}."
    )
