"""One viewing session: a thread that brings a scene to the frame last asked for and prepares the next ones."""

from __future__ import annotations

import logging
import threading
import time
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from server.viewer.evidence import describe_evidence
from server.viewer.layers import Layers, term_color
from server.viewer.scene import ViewerScene

if TYPE_CHECKING:
    from tracker.inspection import FrameView, ViewAids

log = logging.getLogger(__name__)

Answer = dict[str, Any]
Reply = Callable[[Answer | Exception], None]

CACHED_VIEWS = 24
PREFETCHED_VIEWS = 4


@dataclass(frozen=True)
class Request:
    """Show `frame` with `changes` of layers (None: as it is), then call `reply`."""

    frame: int | None
    changes: dict[str, Any]
    reply: Reply


class ViewSession:
    """Owns a viser server. Requests that arrive while another is worked on are answered together by the last one."""

    def __init__(self, recording: Path, track: Path, frame: int | None, dark: bool, reply: Reply) -> None:
        self._recording, self._track_folder = recording, track
        self._layers = Layers(dark=dark)
        self._waiting: list[Request] = [Request(frame, {}, reply)]
        self._changed = threading.Condition()
        self._closing = False
        self._views: OrderedDict[int, FrameView] = OrderedDict()
        self._prepared: dict[int, Layers] = {}
        """Frames to the layers that they were prepared for."""
        self._aids: ViewAids | None = None
        self._frame: int | None = None
        self._step = 1
        self._thread = threading.Thread(target=self._run, name="view-session", daemon=True)
        self._thread.start()

    def show(self, frame: int | None, changes: dict[str, Any], reply: Reply) -> None:
        with self._changed:
            if not self._closing:
                self._waiting.append(Request(frame, changes, reply))
                self._changed.notify()
                return
        reply(RuntimeError("The viewer session was closed."))

    def close(self) -> None:
        with self._changed:
            self._closing = True
            self._changed.notify()

    def _run(self) -> None:
        scene: ViewerScene | None = None
        try:
            scene = self._open()
            while True:
                requests = self._next_requests()
                if requests is None:
                    return
                if requests:
                    try:
                        answer = self._answer(scene, requests)
                    except Exception as error:
                        log.exception("a frame of %s cannot be shown", self._track_folder)
                        answer = error
                    for request in requests:
                        request.reply(answer)
                else:
                    self._prefetch()
        except Exception as error:
            log.exception("viewer session of %s ended", self._track_folder)
            self._refuse_all(error)
        finally:
            self._refuse_all(RuntimeError("The viewer session was closed."))
            if self._aids is not None:
                self._aids.close()
            if scene is not None:
                scene.close()

    def _open(self) -> ViewerScene:
        from tracker import load_sequence, load_track
        from tracker.inspection import ViewAids

        self._sequence = load_sequence(self._recording)
        self._track = load_track(self._track_folder)
        camera = self._sequence.camera(self._track.setup.camera_id)
        self._aids = ViewAids(self._track.setup, camera.T_world_camera)
        self._rows = {int(frame): row for row, frame in enumerate(self._track.frame)}
        first = self._waiting[0].frame
        start = first if first in self._rows else int(self._track.frame[0])
        view = self._view(start)
        focus = np.concatenate([model.vertices for model in view.models]).mean(axis=0).astype(np.float64)
        return ViewerScene(camera, focus, self._layers.dark)

    def _next_requests(self) -> list[Request] | None:
        """Requests that wait; an empty list when there is time to prefetch; None when the session ends."""
        with self._changed:
            while not (self._waiting or self._closing or self._frames_ahead()):
                self._changed.wait()
            if self._closing:
                return None
            requests, self._waiting = self._waiting, []
            return requests

    def _answer(self, scene: ViewerScene, requests: list[Request]) -> Answer:
        began = time.perf_counter()
        before = self._layers
        for request in requests:
            self._layers = self._layers.with_changes(request.changes)
        if self._layers.dark != before.dark:
            scene.set_dark(self._layers.dark)
        asked = [request.frame for request in requests if request.frame is not None]
        frame = self._nearest(asked[-1] if asked else self._frame)
        if self._frame is not None and frame != self._frame:
            self._step = int(np.clip(frame - self._frame, -10, 10))
        self._frame = frame
        view = self._view(frame)
        scene.show(view, self._layers)
        return {
            "port": scene.port,
            "frame": frame,
            "terms": _describe_terms(view, self._layers.dark) if self._layers.correspondences else [],
            **describe_evidence(view, self._layers),
            "milliseconds": round(1000.0 * (time.perf_counter() - began), 1),
        }

    def _nearest(self, frame: int | None) -> int:
        """The frame of the track that is nearest to the one asked for; its first when none is."""
        return min(self._rows, key=lambda held: 0 if frame is None else abs(held - frame))

    def _view(self, frame: int) -> FrameView:
        if frame not in self._views:
            from tracker.inspection import describe_frame

            row = self._rows[frame]
            pose = self._track.pose[row]
            self._views[frame] = describe_frame(self._sequence, self._track.setup, pose, frame, self._aids)
            while len(self._views) > CACHED_VIEWS:
                gone, _ = self._views.popitem(last=False)
                self._prepared.pop(gone, None)
        self._views.move_to_end(frame)
        return self._views[frame]

    def _frames_ahead(self) -> list[int]:
        """Frames to prepare in the direction of travel, nearest first."""
        if self._frame is None:
            return []
        ahead = [self._frame + k * self._step for k in range(1, PREFETCHED_VIEWS + 1)]
        return [frame for frame in ahead if frame in self._rows and self._prepared.get(frame) != self._layers]

    def _prefetch(self) -> None:
        frame = self._frames_ahead()[0]
        try:
            self._layers.prepare(self._view(frame))
            self._prepared[frame] = self._layers
        except Exception as error:
            log.warning("frame %d cannot be prepared: %s", frame, error)
            self._step = 0

    def _refuse_all(self, error: Exception) -> None:
        with self._changed:
            requests, self._waiting = self._waiting, []
            self._closing = True
        for request in requests:
            request.reply(error)


def _describe_terms(view: FrameView, dark: bool) -> list[dict[str, Any]]:
    from tracker.inspection import find_term_look

    return [
        {
            "name": term,
            "label": find_term_look(term).label,
            "count": len(segments),
            "color": "#{:02x}{:02x}{:02x}".format(*term_color(term, dark)),
        }
        for term, segments in view.correspondences.items()
    ]
