"""Joints that people marked in images: `annotations.json`."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.atomic_file import write_atomically
from tracker.capture.document import Node, load_json
from tracker.capture.joint_source import JointSources, parse_source
from tracker.errors import AnnotationError

JOINT_NAMES: tuple[str, ...] = (
    *("wrist", "thumb_cmc", "thumb_mcp", "thumb_ip", "thumb_tip"),
    *("index_mcp", "index_pip", "index_dip", "index_tip", "middle_mcp", "middle_pip", "middle_dip", "middle_tip"),
    *("ring_mcp", "ring_pip", "ring_dip", "ring_tip", "little_mcp", "little_pip", "little_dip", "little_tip"),
)
"""The file's own list of the 21 joints; a test holds it equal to the models' `HAND_JOINTS` (rooms that don't meet)."""

ABSENT, OCCLUDED, VISIBLE = 0, 1, 2
"""What the third number of a joint says, as COCO's keypoints do."""

MAX_ITEMS = 4_000_000
"""Labelled hands in one file; a bound of ours."""
MAX_BYTES = 512 * 1024 * 1024
"""Of one file; a bound of ours."""


@dataclass(frozen=True, eq=False)
class Annotation:
    """One hand in one image.

    Attributes:
        frame: Frame number, from 0.
        camera: Id of the camera.
        hand: `right` or `left`.
        points: (21, 3) float64, in the order of HAND_JOINTS, of x, y (px, pixel centres are integers)
            and v as in COCO: 0 absent, 1 occluded, 2 visible.
        sources: Of each joint, the source that a person accepted (None: placed by hand); None when unknown.
    """

    frame: int
    camera: str
    hand: str
    points: npt.NDArray[np.float64]
    sources: JointSources | None = None

    @property
    def key(self) -> tuple[int, str, str]:
        """What it belongs to: frame, camera, hand."""
        return self.frame, self.camera, self.hand

    def to_json(self) -> dict:
        """Its entry in `annotations.json`."""
        points = [[float(x), float(y), int(v) if v in (0, 1, 2) else float(v)] for x, y, v in self.points]
        document = {"frame": self.frame, "camera": self.camera, "hand": self.hand, "points": points}
        return document | self.describe_sources("sources")

    def describe_sources(self, member: str) -> dict:
        """A member of a JSON object that says where each joint came from; none where it is unknown."""
        if self.sources is None:
            return {}
        return {member: [None if source is None else source.to_json() for source in self.sources]}


@dataclass(frozen=True, eq=False)
class Annotations:
    """All annotations of a recording, at most one for each frame, camera and hand, sorted by them."""

    items: tuple[Annotation, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "items", tuple(sorted(self.items, key=lambda item: item.key)))

    def at(self, frame: int) -> tuple[Annotation, ...]:
        """Those of one frame."""
        return tuple(item for item in self.items if item.frame == frame)

    def find(self, frame: int, camera: str, hand: str) -> Annotation | None:
        """That of one frame, camera and hand."""
        return next((item for item in self.items if item.key == (frame, camera, hand)), None)

    def to_json(self) -> dict:
        """The content of `annotations.json`."""
        return {"version": 1, "joints": list(JOINT_NAMES), "items": [item.to_json() for item in self.items]}


def load_annotations(path: Path | str) -> Annotations:
    """Annotations from a file; its joints may stand in another order, but each of the 21 once."""
    return parse_annotations(load_json(Path(path), MAX_BYTES, AnnotationError))


def parse_annotations(node: Node) -> Annotations:
    """Annotations from the content of `annotations.json`."""
    node.get("version").integer(1, 1)
    names = [item.text(100) for item in node.get("joints").items(100)]
    if sorted(names) != sorted(JOINT_NAMES):
        missing = [name for name in JOINT_NAMES if name not in names]
        foreign = [name for name in names if name not in JOINT_NAMES]
        raise AnnotationError(
            f"{node.file}: needed each of the 21 joints of a hand once; missing {missing or 'none'}, "
            f"unknown {foreign or 'none'}, {len(names)} in all."
        )
    order = [names.index(name) for name in JOINT_NAMES]
    items = tuple(_parse_item(item, order) for item in node.get("items").items(MAX_ITEMS))
    seen: set[tuple[int, str, str]] = set()
    for item in items:
        if item.key in seen:
            raise AnnotationError(f"{node.file}: two items for frame {item.frame}, {item.camera}, {item.hand} hand.")
        seen.add(item.key)
    return Annotations(items)


def save_annotations(path: Path | str, annotations: Annotations | Iterable[Annotation]) -> None:
    """Write `annotations.json`, whole or not at all, checked as if it were foreign."""
    path = Path(path)
    if not isinstance(annotations, Annotations):
        annotations = Annotations(tuple(annotations))
    for item in annotations.items:
        assert item.points.shape == (21, 3), item.points.shape
    document = annotations.to_json()
    parse_annotations(Node(document, str(path), "", AnnotationError))
    write_atomically(path, (json.dumps(document, separators=(",", ":")) + "\n").encode())


def _parse_item(node: Node, order: list[int]) -> Annotation:
    rows = list(node.get("points").items(21))
    if len(rows) != 21:
        raise AnnotationError(f"{node.file}: {node.where}.points has {len(rows)} rows; needed 21 of [x, y, v].")
    points = np.zeros((21, 3))
    for i, row in enumerate(rows):
        cells = list(row.items(3))
        if len(cells) != 3:
            row.fail("[x, y, v]")
        points[i] = cells[0].number(-1e6, 1e6), cells[1].number(-1e6, 1e6), cells[2].number(0, 2)
        if points[i, 2] not in (0, 1, 2):
            cells[2].fail("0 (absent), 1 (occluded) or 2 (visible)")
    frame = node.get("frame").integer(0, 10**9)
    sources = parse_sources(node.get("sources"), order) if node.has("sources") else None
    camera, hand = node.get("camera").text(64), node.get("hand").choice("right", "left")
    return Annotation(frame, camera, hand, points[order], sources)


def parse_sources(node: Node, order: Sequence[int]) -> JointSources:
    """Where joints came from, null by hand; `order` has for each of our joints its place in the file."""
    found = [parse_source(item) for item in node.items(21)]
    if len(found) != 21:
        needed = "needed 21, null where a joint was placed by hand"
        raise AnnotationError(f"{node.file}: {node.where} has {len(found)} entries; {needed}.")
    return tuple(found[i] for i in order)
