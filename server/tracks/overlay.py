"""The mesh of a track drawn over an image of its recording, kept on disk once it was drawn."""

from __future__ import annotations

import os
import threading
import uuid
from collections import OrderedDict
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import cv2
import numpy as np

from server.errors import NotFoundError

if TYPE_CHECKING:
    from tracker import Sequence, Track

OPEN_TRACKS = 4
"""Tracks whose arrays stay in memory."""

Kind = Literal["mesh", "unknown"]

STYLE = 1
"""Part of the file names; raise it when overlays are drawn differently."""


class Overlays:
    """Draws overlays and remembers them below `tracks/<id>/overlays/`."""

    def __init__(self) -> None:
        self._open: OrderedDict[Path, tuple[Sequence, Track, dict[int, int]]] = OrderedDict()
        self._lock = threading.Lock()

    def find(self, track_folder: Path, recording: Path, frame: int, camera: str, kind: Kind = "mesh") -> Path:
        """The PNG of one frame, (H, W) RGBA, drawn now if need be: of the meshes, or what is unknown."""
        sequence, track, rows = self._load(track_folder, recording)
        cameras = [c.id for c in sequence.cameras]
        if camera not in cameras:
            raise NotFoundError(f"The recording has no camera {camera!r}; it has {', '.join(cameras)}.")
        if frame not in rows:
            raise NotFoundError(f"The track has no frame {frame}; it has {min(rows)} to {max(rows)}.")
        name = f"{STYLE}-{cameras.index(camera)}-{frame:06d}.png"
        path = track_folder / "overlays" / (name if kind == "mesh" else f"{kind}-{name}")
        if not path.exists():
            from tracker.inspection import render_overlay, render_unknown

            render = render_overlay if kind == "mesh" else render_unknown
            image = render(sequence, track.setup, track.pose[rows[frame]], frame, camera)
            _write_png(path, image)
        return path

    def _load(self, track_folder: Path, recording: Path) -> tuple[Sequence, Track, dict[int, int]]:
        from tracker import load_sequence, load_track

        with self._lock:
            if track_folder not in self._open:
                track = load_track(track_folder)
                rows = {int(frame): row for row, frame in enumerate(track.frame)}
                self._open[track_folder] = (load_sequence(recording), track, rows)
                while len(self._open) > OPEN_TRACKS:
                    self._open.popitem(last=False)
            self._open.move_to_end(track_folder)
            return self._open[track_folder]


def _write_png(path: Path, image: np.ndarray) -> None:
    path.parent.mkdir(exist_ok=True)
    temporary = path.with_name(f".{uuid.uuid4().hex}.png")
    done, data = cv2.imencode(".png", cv2.cvtColor(image, cv2.COLOR_RGBA2BGRA), [cv2.IMWRITE_PNG_COMPRESSION, 1])
    assert done
    temporary.write_bytes(data.tobytes())
    os.replace(temporary, path)
