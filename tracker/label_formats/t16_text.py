"""[T16]'s own layout: `<camera>/joints_2D_GT/NNN.txt`, a line `number x y` for each joint of a frame, whole px.

Source: what programs that read the published files do: three columns, the frame number with three digits as the file's
name, x or y of 0 or less for a joint that is not there; cameras are numbered from 1. Which joint a number means is
published nowhere that we know: our files say it in `joints.txt` beside the folder, and files without one are only read
when somebody says the order. The published principal point (319.5, 239.5 in 640x480) makes pixel centres whole numbers.
"""

from __future__ import annotations

import re

import numpy as np

from tracker.capture.annotations import Annotation
from tracker.errors import AnnotationError, reading
from tracker.label_formats.label_set import (
    ExportedLabels,
    ImportCollector,
    ImportedLabels,
    ImportHints,
    LabelSet,
    Notes,
    note_flat_visibility,
)
from tracker.label_formats.orders import JOINT_ORDERS, find_joint
from tracker.model.joints import HAND_JOINTS, SIDES

FOLDER = "joints_2D_GT"
NAMES_FILE = "joints.txt"
MAX_LINES = 1000
"""Of a file; a bound of ours."""
MAX_NUMBER = 10**6
"""px; a bound of ours."""
_LINE = re.compile(r"\s*(-?\d{1,7})\s+(-?\d{1,7})\s+(-?\d{1,7})\s*")
_PATH = re.compile(rf"(?:(?:.*/)?([^/]+)/)?{FOLDER}/(\d{{1,9}})\.txt")
Slots = dict[int, tuple[str, int]]
"""Hand and joint of each number."""


def write_t16(sets: list[LabelSet]) -> ExportedLabels:
    """A file a frame, 42 lines: the right hand's joints, then the left's."""
    (only,) = sets
    losses = Notes()
    note_flat_visibility(losses, only.annotations.items, "The layout")
    files, joints = {}, 0
    for number, camera in enumerate(only.sequence.cameras, 1):
        frames: dict[int, dict[str, Annotation]] = {}
        for item in only.annotations.items:
            if item.camera == camera.id:
                frames.setdefault(item.frame, {})[item.hand] = item
        for frame, hands in sorted(frames.items()):
            text, count = _write_frame(hands, losses)
            files[f"{number}/{FOLDER}/{frame:03d}.txt"] = text.encode()
            joints += count
        if frames:
            names = [f"{i}\t{hand}/{joint}" for i, (hand, joint) in enumerate(_list_slots())]
            files[f"{number}/{NAMES_FILE}"] = ("\n".join(names) + "\n").encode()
    if not files:
        raise AnnotationError("There are no labels to write; mark some first.")
    return ExportedLabels(files, len(only.annotations.items), joints, losses.sentences())


def _list_slots() -> list[tuple[str, str]]:
    return [(hand, joint) for hand in SIDES for joint in HAND_JOINTS]


def _write_frame(hands: dict[str, Annotation], losses: Notes) -> tuple[str, int]:
    lines, count = [], 0
    for number, (hand, joint) in enumerate(_list_slots()):
        x = y = 0
        if hand in hands:
            px, py, v = hands[hand].points[HAND_JOINTS.index(joint)]
            if v > 0:
                x, y = round(px), round(py)
                losses.add("{n} [position was|positions were] rounded to whole px", count=int((x, y) != (px, py)))
                if x <= 0 or y <= 0:
                    losses.add(
                        "{n} [joint|joints] at x or y of 0 or less [was|were] left out: there it means not labelled",
                        joint,
                    )
                    x = y = 0
                else:
                    count += 1
        lines.append(f"{number}\t{x}\t{y}")
    return "\n".join(lines) + "\n", count


def read_t16(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """Files of frames; what the numbers mean is said by `joints.txt` or by the hints `joint_order` and `hand`."""
    (only,) = sets
    collector = ImportCollector(sets)
    found = {name: match for name in sorted(files) if (match := _PATH.fullmatch(name))}
    if not found:
        raise AnnotationError(f"Needed files .../{FOLDER}/NNN.txt; found {', '.join(sorted(files)[:5]) or 'none'}.")
    slots: dict[str, Slots] = {}
    for name, match in found.items():
        folder = name[: -len(f"{FOLDER}/{match[2]}.txt")]
        if folder not in slots:
            slots[folder] = _read_slots(files, folder, hints)
        camera = _find_camera(match[1], only, hints)
        frame = int(match[2])
        if frame >= only.sequence.frame_count:
            collector.problems.add(
                "{n} [file is of a frame|files are of frames] that the recording does not have", name
            )
            continue
        for hand, points in _read_frame(name, files[name], slots[folder]).items():
            collector.add(only.key, Annotation(frame, camera, hand, points))
    collector.warnings.add("The layout does not say what is occluded; {n} [file has|files have] every joint as visible",
                           count=len(found))  # fmt: skip
    return collector.finish()


def _find_camera(number: str | None, labels: LabelSet, hints: ImportHints) -> str:
    cameras = [camera.id for camera in labels.sequence.cameras]
    if hints.camera is not None:
        if hints.camera not in cameras:
            raise AnnotationError(f"The recording has no camera {hints.camera!r}; it has {', '.join(cameras)}.")
        return hints.camera
    if len(cameras) == 1:
        return cameras[0]
    if number is not None and number.isdecimal() and 1 <= int(number[:9]) <= len(cameras):
        return cameras[int(number[:9]) - 1]
    raise AnnotationError(
        f"Which camera {FOLDER} belongs to is unknown; give the option camera ({', '.join(cameras)})."
    )


def _read_slots(files: dict[str, bytes], folder: str, hints: ImportHints) -> Slots:
    if hints.joint_order is not None:
        if hints.joint_order not in JOINT_ORDERS:
            raise AnnotationError(
                f"There is no joint order {hints.joint_order!r}; there are {', '.join(JOINT_ORDERS)}."
            )
        hands = (hints.hand,) if hints.hand else SIDES
        order = [(hand, HAND_JOINTS.index(joint)) for hand in hands for joint in JOINT_ORDERS[hints.joint_order]]
        return dict(enumerate(order))
    name = f"{folder}{NAMES_FILE}"
    if name not in files:
        raise AnnotationError(
            f"{folder}{FOLDER} numbers its joints, but does not name them. Put a {NAMES_FILE} beside it (lines "
            "such as '0 right/wrist'), or give the option joint_order, and hand if there is one hand only."
        )
    slots: Slots = {}
    for line in _decode(name, files[name]).splitlines()[:MAX_LINES]:
        words = line.split()
        side, _, joint_name = words[1].partition("/") if len(words) == 2 else ("", "", "")
        joint = find_joint(joint_name)
        if not words:
            continue
        if joint is None or side not in SIDES or not words[0].isdecimal() or int(words[0][:9]) in slots:
            raise AnnotationError(f"{name}: {line[:80]!r}; needed lines such as '0 right/wrist', each number once.")
        slots[int(words[0][:9])] = (side, joint)
    if len(set(slots.values())) != len(slots):
        raise AnnotationError(f"{name}: names a joint twice.")
    return slots


def _read_frame(name: str, data: bytes, slots: Slots) -> dict[str, np.ndarray]:
    lines = [line for line in _decode(name, data).splitlines() if line.strip()]
    if len(lines) > MAX_LINES:
        raise AnnotationError(f"{name}: has {len(lines)} lines; at most {MAX_LINES} are read.")
    hands: dict[str, np.ndarray] = {}
    seen: set[int] = set()
    for line in lines:
        match = _LINE.fullmatch(line)
        if match is None:
            raise AnnotationError(f"{name}: {line[:80]!r}; needed a joint's number, x and y as whole numbers.")
        number, x, y = (int(cell) for cell in match.groups())
        if number not in slots:
            raise AnnotationError(f"{name}: joint {number} is not among the {len(slots)} that were named.")
        if number in seen:
            raise AnnotationError(f"{name}: joint {number} appears twice.")
        if abs(x) > MAX_NUMBER or abs(y) > MAX_NUMBER:
            raise AnnotationError(f"{name}: joint {number} is at ({x}, {y}) px.")
        seen.add(number)
        if x > 0 and y > 0:
            hand, joint = slots[number]
            hands.setdefault(hand, np.zeros((len(HAND_JOINTS), 3)))[joint] = x, y, 2
    return hands


def _decode(name: str, data: bytes) -> str:
    with reading(AnnotationError, name, "text in UTF-8"):
        return data.decode("utf-8-sig")
