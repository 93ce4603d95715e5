"""Images of a recording's frames as a browser can show them."""

from __future__ import annotations

import threading
import uuid
from collections import OrderedDict
from dataclasses import dataclass
from typing import Annotated

import cv2
import numpy as np
import numpy.typing as npt
from fastapi import Depends
from starlette.requests import HTTPConnection

from server.database import Database
from server.errors import NotFoundError
from server.sequences import service
from server.sequences.depth_colors import Colormap, index_depth, load_palette
from server.sequences.image_cache import ImageCache
from server.sequences.palette_png import encode_palette_png
from server.storage import Storage
from tracker import Sequence

JPEG_QUALITY = 92
THUMBNAIL_QUALITY = 80
THUMBNAIL_WIDTH = 240
"""px"""
MAX_OPEN = 64


@dataclass(frozen=True)
class FrameAddress:
    """One frame of one camera, of a recording whose files are those of the content key."""

    sequence_id: uuid.UUID
    content_key: str
    camera: str
    frame: int


@dataclass(frozen=True)
class OpenRecording:
    """A recording at hand, with near and far in m of each depth camera."""

    recording: Sequence
    ranges: dict[str, tuple[float, float]]


class FrameImages:
    """Makes and remembers images. Recordings stay open here under their content key, so a frame costs no query."""

    def __init__(self, database: Database, storage: Storage, cache_bytes: int) -> None:
        self._database, self._storage = database, storage
        self._cache = ImageCache(cache_bytes)
        self._open: OrderedDict[tuple[uuid.UUID, str], OpenRecording] = OrderedDict()
        self._lock = threading.Lock()

    def color_jpeg(self, at: FrameAddress) -> bytes:
        """The colour image: the stored bytes when they are a JPEG that browsers show as it is, else encoded."""
        recording = self._find(at, "color").recording
        path = recording.image_path("color", at.frame, at.camera)
        if path.suffix.lower() in (".jpg", ".jpeg"):
            data = path.read_bytes()
            if data.startswith(b"\xff\xd8\xff") and b"Exif\x00" not in data[:65536]:  # Exif may turn the image
                return data
        return self._cache.get((at, "color"), lambda: _encode_jpeg(recording.color(at.frame, at.camera), JPEG_QUALITY))

    def depth_png(self, at: FrameAddress, colormap: Colormap, near: float | None, far: float | None) -> bytes:
        """Depth in colours; near and far in m, those of the recording when not given."""
        opened = self._find(at, "depth")
        usual = opened.ranges[at.camera]
        low = usual[0] if near is None else near
        high = max(usual[1] if far is None else far, low + 1e-3)

        def make() -> bytes:
            return encode_palette_png(_index(opened.recording, at, (low, high)), load_palette(colormap))

        return self._cache.get((at, colormap, low, high), make)

    def depth_raw(self, at: FrameAddress) -> tuple[npt.NDArray[np.uint16], float]:
        """(H, W) raw depth and its scale in m."""
        recording = self._find(at, "depth").recording
        return recording.depth_raw(at.frame, at.camera), recording.camera(at.camera).depth_scale

    def thumbnail_jpeg(self, at: FrameAddress) -> bytes:
        """A small picture of a frame: its colour, or its depth on black."""
        opened = self._find(at, None)
        recording = opened.recording

        def make() -> bytes:
            if recording.camera(at.camera).has_color:
                image = recording.color(at.frame, at.camera)
            else:
                image = load_palette("viridis")[_index(recording, at, opened.ranges[at.camera])]
            height = max(1, round(image.shape[0] * THUMBNAIL_WIDTH / image.shape[1]))
            small = cv2.resize(image, (THUMBNAIL_WIDTH, height), interpolation=cv2.INTER_AREA)
            return _encode_jpeg(small.astype(np.uint8), THUMBNAIL_QUALITY)

        return self._cache.get((at, "thumbnail"), make)

    def _find(self, at: FrameAddress, kind: str | None) -> OpenRecording:
        """The recording, which has images of this kind (or any, for None) at the address."""
        opened = self._open_recording(at.sequence_id, at.content_key)
        recording = opened.recording
        camera = next((item for item in recording.cameras if item.id == at.camera), None)
        if camera is None:
            known = [item.id for item in recording.cameras]
            raise NotFoundError(f"{recording.name} has no camera {at.camera!r}; it has {known}.")
        if kind is not None and not (camera.has_color if kind == "color" else camera.has_depth):
            raise NotFoundError(f"The camera {at.camera!r} of {recording.name} has no {kind} images.")
        if not 0 <= at.frame < recording.frame_count:
            last = recording.frame_count - 1
            raise NotFoundError(f"{recording.name} has no frame {at.frame}; they go from 0 to {last}.")
        return opened

    def _open_recording(self, sequence_id: uuid.UUID, content_key: str) -> OpenRecording:
        key = (sequence_id, content_key)
        with self._lock:
            if key in self._open:
                self._open.move_to_end(key)
                self._storage.folder(service.AREA, sequence_id)  # with a store behind it, it may have left this machine
                return self._open[key]
        with self._database.reading() as session:
            row = service.get_sequence(session, sequence_id, deleted_too=True)
        if row.content_key != content_key:
            raise NotFoundError(f"The recording {sequence_id} has other files than those of the key {content_key!r}.")
        ranges = {item["id"]: (item["depth_near"], item["depth_far"]) for item in row.cameras if item["has_depth"]}
        opened = OpenRecording(service.open_sequence(self._storage, sequence_id), ranges)
        with self._lock:
            self._open[key] = opened
            while len(self._open) > MAX_OPEN:
                self._open.popitem(last=False)
        return opened


def _index(recording: Sequence, at: FrameAddress, near_far: tuple[float, float]) -> npt.NDArray[np.uint8]:
    return index_depth(recording.depth_raw(at.frame, at.camera), recording.camera(at.camera).depth_scale, *near_far)


def _encode_jpeg(image: npt.NDArray[np.uint8], quality: int) -> bytes:
    """JPEG of (H, W, 3) RGB."""
    is_done, data = cv2.imencode(".jpg", cv2.cvtColor(image, cv2.COLOR_RGB2BGR), [cv2.IMWRITE_JPEG_QUALITY, quality])
    assert is_done
    return data.tobytes()


async def get_frame_images(connection: HTTPConnection) -> FrameImages:
    """The app's."""
    return connection.app.state.frame_images


FrameImagesDep = Annotated[FrameImages, Depends(get_frame_images)]
