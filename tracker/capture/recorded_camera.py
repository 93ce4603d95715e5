"""A camera and where its images lie."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tracker.capture.calibration import MAX_SIDE, check_distortion, check_image_size, check_intrinsics, check_rigid
from tracker.capture.camera import Camera
from tracker.capture.document import Node
from tracker.capture.frame_pattern import FramePattern, find_pattern_fault, parse_pattern
from tracker.capture.image_file import COLOR_SUFFIXES, DEPTH_SUFFIXES
from tracker.capture.relative_path import find_path_fault
from tracker.capture.video_file import VIDEO_SUFFIXES


@dataclass(frozen=True, eq=False)
class RecordedCamera(Camera):
    """A calibrated camera of a recording.

    Attributes:
        color: Pattern of its colour images, or None.
        film: Relative path of the video that its colour images are decoded from, or None; never beside `color`.
        depth: Pattern of its depth images, registered to the same pixels, or None.
        depth_scale: m per unit of the depth images.
    """

    color: FramePattern | None = None
    depth: FramePattern | None = None
    depth_scale: float = 0.001
    film: str | None = None

    @property
    def has_color(self) -> bool:
        return self.color is not None or self.film is not None

    @property
    def has_depth(self) -> bool:
        return self.depth is not None

    def to_json(self) -> dict:
        """Its entry in `sequence.json`."""
        entry: dict = {
            "id": self.id,
            "width": self.width,
            "height": self.height,
            "K": np.asarray(self.K, dtype=np.float64).tolist(),
            "distortion": np.asarray(self.distortion, dtype=np.float64).tolist(),
            "T_world_camera": np.asarray(self.T_world_camera, dtype=np.float64).tolist(),
        }
        if self.color is not None:
            entry["color"] = str(self.color)
        if self.film is not None:
            entry["film"] = self.film
        if self.depth is not None:
            entry["depth"] = str(self.depth)
            entry["depth_scale"] = float(self.depth_scale)
        return entry


def parse_camera(node: Node) -> RecordedCamera:
    """A camera from its entry in `sequence.json`; raises SequenceError or CalibrationError."""
    what = f"{node.file}: {node.where}"
    width, height = node.get("width").integer(8, MAX_SIDE), node.get("height").integer(8, MAX_SIDE)
    check_image_size(what, width, height)
    K = node.get("K").matrix(3, 3)
    check_intrinsics(f"{what}.K", K, width, height)
    distortion = node.get("distortion").vector(14) if node.has("distortion") else np.zeros(0)
    check_distortion(f"{what}.distortion", distortion)
    T = node.get("T_world_camera").matrix(4, 4) if node.has("T_world_camera") else np.eye(4)
    check_rigid(f"{what}.T_world_camera", T)
    color = _parse_images(node.get("color"), COLOR_SUFFIXES) if node.has("color") else None
    depth = _parse_images(node.get("depth"), DEPTH_SUFFIXES) if node.has("depth") else None
    film = _parse_film(node.get("film")) if node.has("film") else None
    if color is None and depth is None and film is None:
        raise node.error(
            f"{what} has neither 'color' nor 'depth' nor 'film'; needed a pattern of image files, or a video."
        )
    if color is not None and film is not None:
        raise node.error(f"{what} has both 'color' and 'film'; leave out one of them.")
    if color is not None and color == depth:
        raise node.error(f"{what}: 'color' and 'depth' are the same files ({color}).")
    depth_scale = node.get("depth_scale").number(1e-7, 1.0) if depth is not None else 0.001
    return RecordedCamera(_parse_id(node.get("id")), width, height, K, distortion, T, color, depth, depth_scale, film)


def _parse_id(node: Node) -> str:
    """An id stands in addresses and file names, so it is made of few kinds of characters."""
    name = node.text(64)
    if not all(c.isascii() and (c.isalnum() or c in "._-") for c in name) or not name[0].isalnum():
        node.fail("letters, digits, dots, dashes and underscores, a letter or digit first")
    if find_path_fault(name):
        node.fail("a name that can be a folder")
    return name


def _parse_film(node: Node) -> str:
    text = node.text(1024)
    fault = find_path_fault(text)
    if fault:
        raise node.error(f"{node.file}: {node.where} {text!r} {fault}.")
    if not text.lower().endswith(VIDEO_SUFFIXES):
        node.fail(f"a video ({', '.join(VIDEO_SUFFIXES)})")
    return text


def _parse_images(node: Node, suffixes: tuple[str, ...]) -> FramePattern:
    text = node.text(1024)
    fault = find_pattern_fault(text, suffixes)
    if fault:
        raise node.error(f"{node.file}: {node.where} {text!r} {fault}.")
    return parse_pattern(text)
