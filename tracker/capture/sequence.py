"""A recording on disk: `sequence.json` and the image files or videos it names."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.atomic_file import write_atomically
from tracker.capture.document import Node, load_json, read_regular_file
from tracker.capture.film import Film
from tracker.capture.frame import Frame
from tracker.capture.image_file import MAX_IMAGE_BYTES, decode_color, decode_depth
from tracker.capture.recorded_camera import RecordedCamera, parse_camera
from tracker.capture.recorded_object import RecordedObject, parse_object
from tracker.capture.relative_path import find_path_fault, is_inside
from tracker.capture.static_plane import MAX_PLANES, StaticPlane, parse_direction, parse_plane
from tracker.capture.video_file import MAX_FRAMES, VideoFile
from tracker.errors import FrameError, SequenceError

SEQUENCE_FILE = "sequence.json"
TRUTH_FILE = "truth.npz"
"""In the folder of a rendered recording: the poses it was made from."""
MAX_DOCUMENT_BYTES = 8 * 1024 * 1024
"""Of sequence.json; a bound of ours."""


@dataclass(frozen=True, eq=False)
class Sequence:
    """A recording, checked; its images are read when asked for.

    Attributes:
        folder: Where it lies.
        name: For people.
        fps: Frames per second.
        frame_count: Frames are numbered from 0.
        cameras: At least one.
        hands: Those of `right`, `left` that it shows.
        objects: Those that are handled.
        annotations: Relative path of its annotations, or None.
        gravity: (3,) unit, direction of gravity, world; None when not given.
        planes: Tables, floors and walls that were measured.
    """

    folder: Path
    name: str
    fps: float
    frame_count: int
    cameras: tuple[RecordedCamera, ...]
    hands: tuple[str, ...] = ("right",)
    objects: tuple[RecordedObject, ...] = ()
    annotations: str | None = None
    gravity: tuple[float, float, float] | None = None
    planes: tuple[StaticPlane, ...] = ()

    @property
    def annotations_path(self) -> Path | None:
        """Its annotation file, whether or not it exists yet."""
        return None if self.annotations is None else self._inside(self.annotations, SequenceError)

    def object_path(self, name: str) -> Path:
        """Model file of an object."""
        for item in self.objects:
            if item.name == name:
                return self._inside(item.model, SequenceError)
        raise SequenceError(f"{self.name}: has no object {name!r}; it has {[o.name for o in self.objects]}.")

    def camera(self, camera_id: str) -> RecordedCamera:
        """The camera of this id."""
        for camera in self.cameras:
            if camera.id == camera_id:
                return camera
        raise SequenceError(f"{self.name}: has no camera {camera_id!r}; it has {[c.id for c in self.cameras]}.")

    def image_path(self, kind: str, index: int, camera_id: str) -> Path:
        """File of the `color` or `depth` image of a frame; it need not exist, but lies inside the recording.

        A camera's film has none of its own for a frame: FrameError.
        """
        assert kind in ("color", "depth"), kind
        camera = self.camera(camera_id)
        pattern = camera.color if kind == "color" else camera.depth
        if pattern is None:
            raise FrameError(f"{self.name}: camera {camera_id} has no files of {kind} images.")
        self._check_index(index)
        return self._inside(pattern.path(index), FrameError)

    def frame(self, index: int, camera_id: str) -> Frame:
        """Images of one camera at one frame: colour RGB, depth in m (0 where there is no value)."""
        camera = self.camera(camera_id)
        depth = None
        if camera.has_depth:
            depth = self.depth_raw(index, camera_id).astype(np.float32)
            depth *= np.float32(camera.depth_scale)
        return Frame(index, camera_id, self.color(index, camera_id) if camera.has_color else None, depth)

    def color(self, index: int, camera_id: str) -> npt.NDArray[np.uint8]:
        """(H, W, 3) uint8 RGB; not to be written to."""
        if (film := self.camera(camera_id).film) is not None:
            self._check_index(index)
            path = self._inside(film, FrameError)
            try:
                image = self.films[camera_id].frame(index)
            except FrameError as fault:
                raise FrameError(f"Camera {camera_id}: {fault}") from fault
            return self._checked(image, path, camera_id)
        path = self.image_path("color", index, camera_id)
        image = decode_color(read_regular_file(path, MAX_IMAGE_BYTES, FrameError), str(path))
        return self._checked(image, path, camera_id)

    def depth_raw(self, index: int, camera_id: str) -> npt.NDArray[np.uint16]:
        """(H, W) uint16 in units of the camera's depth_scale, 0 where there is no value."""
        path = self.image_path("depth", index, camera_id)
        image = decode_depth(read_regular_file(path, MAX_IMAGE_BYTES, FrameError), str(path))
        return self._checked(image, path, camera_id)

    @cached_property
    def films(self) -> dict[str, Film]:
        """The films by camera, each opened when a frame of it is asked for."""
        films = {camera.id: camera.film for camera in self.cameras if camera.film is not None}
        return {name: Film(VideoFile(self.folder, film), self.frame_count) for name, film in films.items()}

    def _check_index(self, index: int) -> None:
        if not 0 <= index < self.frame_count:
            raise FrameError(f"{self.name}: there is no frame {index}; frames go from 0 to {self.frame_count - 1}.")

    def _checked(self, image: np.ndarray, path: Path, camera_id: str) -> np.ndarray:
        camera = self.camera(camera_id)
        if image.shape[:2] != (camera.height, camera.width):
            found = f"{image.shape[1]}x{image.shape[0]}"
            raise FrameError(f"{path}: is {found} px; camera {camera_id} is {camera.width}x{camera.height} px.")
        return image

    def _inside(self, relative: str, error: type[SequenceError] | type[FrameError]) -> Path:
        path = self.folder / relative
        if not is_inside(path, self.folder):
            raise error(f"{path}: leads out of the recording; copy the file into it instead of linking to it.")
        return path

    def to_json(self) -> dict:
        """The content of `sequence.json`."""
        document: dict = {
            "version": 1,
            "name": self.name,
            "fps": float(self.fps),
            "frame_count": int(self.frame_count),
            "cameras": [camera.to_json() for camera in self.cameras],
            "hands": list(self.hands),
            "objects": [item.to_json() for item in self.objects],
        }
        if self.annotations is not None:
            document["annotations"] = self.annotations
        if self.gravity is not None:
            document["gravity"] = list(self.gravity)
        if self.planes:
            document["planes"] = [plane.to_json() for plane in self.planes]
        return document


def load_sequence(folder: Path | str) -> Sequence:
    """The recording in a folder. Images are not looked at; `check_import` does that."""
    folder = Path(folder)
    if not folder.is_dir():
        raise SequenceError(f"{folder}: is not a folder; needed a recording folder with a {SEQUENCE_FILE}.")
    path = folder / SEQUENCE_FILE
    if not is_inside(path, folder):
        raise SequenceError(f"{path}: leads out of the recording.")
    return parse_sequence(load_json(path, MAX_DOCUMENT_BYTES, SequenceError), folder)


def parse_sequence(node: Node, folder: Path) -> Sequence:
    """A recording from the content of its `sequence.json`; raises SequenceError or CalibrationError."""
    node.get("version").integer(1, 1)
    cameras = tuple(parse_camera(item) for item in node.get("cameras").items(64))
    if not cameras:
        node.get("cameras").fail("at least one camera")
    _check_distinct(node, "cameras", [camera.id for camera in cameras])
    hands = tuple(item.choice("right", "left") for item in node.get("hands").items(2)) if node.has("hands") else ()
    _check_distinct(node, "hands", list(hands))
    objects = tuple(parse_object(o) for o in node.get("objects").items(100)) if node.has("objects") else ()
    _check_distinct(node, "objects", [item.name for item in objects])
    annotations = node.get("annotations").text(1024) if node.has("annotations") else None
    if annotations is not None and (fault := find_path_fault(annotations)):
        raise node.error(f"{node.file}: annotations {annotations!r} {fault}.")
    return Sequence(
        folder=folder,
        name=node.get("name").text(200),
        fps=node.get("fps").number(0.001, 100_000),
        frame_count=node.get("frame_count").integer(1, MAX_FRAMES),
        cameras=cameras,
        hands=hands,
        objects=objects,
        annotations=annotations,
        gravity=parse_direction(node.get("gravity")) if node.has("gravity") else None,
        planes=tuple(parse_plane(p) for p in node.get("planes").items(MAX_PLANES)) if node.has("planes") else (),
    )


def save_sequence_json(sequence: Sequence) -> Path:
    """Write `sequence.json` into the recording's folder, whole or not at all, and checked as if it were foreign."""
    path = sequence.folder / SEQUENCE_FILE
    document = sequence.to_json()
    parse_sequence(Node(document, str(path), "", SequenceError), sequence.folder)
    write_atomically(path, (json.dumps(document, indent=2, ensure_ascii=False) + "\n").encode())
    return path


def _check_distinct(node: Node, key: str, names: list[str]) -> None:
    """No two of the same name, upper and lower case taken as one."""
    if len({name.casefold() for name in names}) != len(names):
        raise SequenceError(f"{node.file}: {key} {names} holds a name twice.")
