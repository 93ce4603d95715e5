"""What the person who imports a recording says about it."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

from tracker.capture.document import Node
from tracker.capture.frame_shifts import parse_shifts
from tracker.capture.recorded_object import UNIT_LIMITS
from tracker.errors import ImportRefusedError


def _help(text: str) -> Any:
    return field(default=None, metadata={"help": text})


@dataclass(frozen=True)
class ImportOptions:
    """Facts that files do not tell; None where nothing was said.

    Each field's help text stands in its metadata.
    """

    name: str | None = _help("Name of the recording; that of the folder when empty.")
    fps: float | None = _help("Frames per second.")
    fx: float | None = _help("Focal length along x, px.")
    fy: float | None = _help("Focal length along y, px; as fx when empty.")
    cx: float | None = _help("Principal point x, px.")
    cy: float | None = _help("Principal point y, px.")
    distortion: tuple[float, ...] | None = _help("OpenCV distortion coefficients; none when empty.")
    intrinsics: str | None = _help("TUM RGB-D: the camera it was recorded with.")
    preset: str | None = _help("A depth camera whose typical values replace those that are not given.")
    depth_scale: float | None = _help("Metres per unit of the depth images, 0.001 for millimetres.")
    depth_pattern: str | None = _help("Pattern of the depth images, such as depth/depth_*.png.")
    color_pattern: str | None = _help("Pattern of the colour images; 'none' to import depth alone.")
    hands: tuple[str, ...] | None = _help("Hands in the recording: right, left or both.")
    allow_gaps: bool | None = _help("Import although frames are missing; the report says which.")
    world_unit_m: float | None = _help("Metres per unit of the calibration, such as 0.001 or a checkerboard square.")
    object_unit_m: float | None = _help("Metres per unit of the objects' meshes, where sequence.json does not give it.")
    camera_shifts: str | None = _help("Frames by which a moment is later in a camera's video: cam1=+3, cam2=-2.")
    color_format: str | None = _help("How frames of videos are stored: jpeg (quality 95) or png.")

    def to_json(self) -> dict[str, Any]:
        """Only what was said."""
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return {k: list(v) if isinstance(v, tuple) else v for k, v in values.items() if v is not None}

    @classmethod
    def from_json(cls, document: Any) -> ImportOptions:
        """Options from outside; `format` beside them is left to the caller; an empty text means nothing was said."""
        node = Node(document, "import options", "", ImportRefusedError)
        known = {f.name for f in fields(cls)}
        unknown = sorted(str(key) for key in node.members() if key not in known | {"format"})
        if unknown:
            raise ImportRefusedError(
                f"import options: unknown {', '.join(unknown)[:200]}; known: {', '.join(sorted(known))}."
            )
        values: dict[str, Any] = {}
        for key in known:
            if node.has(key) and node.value[key] != "":
                values[key] = _parse(key, node.get(key))
        return cls(**values)


def _parse(key: str, node: Node) -> Any:
    if key == "name":
        return node.text(200).strip()
    if key in ("depth_pattern", "color_pattern"):
        return node.text(1024)
    if key == "camera_shifts":
        parse_shifts(text := node.text(2000))
        return text
    if key == "preset":
        return node.text(64)
    if key == "intrinsics":
        return node.choice("freiburg1", "freiburg2", "freiburg3", "ros_default")
    if key == "color_format":
        return node.choice("jpeg", "png")
    if key == "hands":
        hands = tuple(item.choice("right", "left") for item in node.items(2))
        if len(set(hands)) != len(hands):
            node.fail("each hand once")
        return hands
    if key == "distortion":
        return tuple(float(v) for v in node.vector(14))
    if key == "allow_gaps":
        if not isinstance(node.value, bool):
            node.fail("true or false")
        return node.value
    limits = {
        "fps": (0.001, 100_000),
        "depth_scale": (1e-7, 1.0),
        "world_unit_m": (1e-6, 1e4),
        "object_unit_m": UNIT_LIMITS,
        "cx": (-1e5, 1e5),
        "cy": (-1e5, 1e5),
    }
    return node.number(*limits.get(key, (1e-3, 1e7)))
