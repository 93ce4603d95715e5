"""A finished track and its folder."""

from __future__ import annotations

import json
from collections.abc import Sequence as Several
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence
from tracker.errors import TrackingError
from tracker.fitting.setup import TrackSetup
from tracker.model.joints import HAND_JOINTS
from tracker.tracking.arrays_file import load_arrays, save_arrays
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.frame_result import STATUSES
from tracker.tracking.view_errors import ViewErrors, measure_views
from tracker.tracking.watch_objects import OBJECT_STATUSES

Array = npt.NDArray[np.float64]

VIEWS_FILE = "views.npz"
"""In a track's folder, where several colour cameras were tracked in."""


@dataclass(frozen=True)
class Track:
    """Joints and poses of every tracked frame.

    Attributes:
        setup: Models and options of the run.
        camera_ids: C cameras of the recording, in the order of `joints_2d`.
        chunk: The columns of all frames.
        joints_3d: (T, J, 3) world, m.
        joints_2d: (T, C, J, 2) px of each camera of the recording, NaN behind it.
        T_world_object: (T, O, 4, 4) m.
        views: How well the colour cameras agree, where several are tracked in.
    """

    setup: TrackSetup
    camera_ids: tuple[str, ...]
    chunk: TrackChunk
    joints_3d: Array
    joints_2d: Array
    T_world_object: Array
    views: ViewErrors | None = None

    @property
    def frame(self) -> npt.NDArray[np.int64]:
        """(T,) frame numbers."""
        return self.chunk.frame

    @property
    def pose(self) -> Array:
        """(T, D)."""
        return self.chunk.pose

    @property
    def seconds(self) -> Array:
        """(T,)."""
        return self.chunk.seconds

    @property
    def joint_names(self) -> tuple[str, ...]:
        return self.setup.joint_names

    @property
    def status(self) -> npt.NDArray[np.str_]:
        """(T,) of `ok`, `lost`, `recovered`."""
        return np.array(STATUSES, dtype=np.str_)[self.chunk.status]

    @property
    def hand_status(self) -> npt.NDArray[np.str_]:
        """(T, H) the same of each hand; H is 0 in tracks made before it was recorded."""
        return np.array(STATUSES, dtype=np.str_)[self.chunk.hand_status]

    @property
    def object_status(self) -> npt.NDArray[np.str_]:
        """(T, O) of `ok`, `lost`, `recovered`, `hidden`; O is 0 in tracks made before it was recorded."""
        return np.array(OBJECT_STATUSES, dtype=np.str_)[self.chunk.object_status]

    def summary(self) -> dict[str, Any]:
        """The content of `summary.json`."""
        chunk = self.chunk
        milliseconds = 1000.0 * chunk.seconds
        ok = self.status == "ok"
        stages = {
            str(name): round(float(np.median(1000.0 * chunk.stages[:, column])), 3)
            for column, name in enumerate(chunk.stage_names)
        }
        return {
            "frames": len(chunk.frame),
            "lost": int(np.count_nonzero(self.status == "lost")),
            "recovered": int(np.count_nonzero(self.status == "recovered")),
            "median_ms": round(float(np.median(milliseconds)), 3),
            "p95_ms": round(float(np.percentile(milliseconds, 95)), 3),
            "stages_ms": stages,
            "depth_residual_mm": _median(chunk.depth_residual_mm[ok]),
            "silhouette_iou": _median(chunk.silhouette_iou[ok]),
            "threads": self.setup.options.threads,
            "colour_cameras": list(self.setup.view_ids),
            "is_distance_guessed": self.setup.is_distance_guessed,
            "doubts": [] if self.views is None else list(self.views.doubts()),
            "views": {} if self.views is None else self.views.summary(),
            "detector": None if self.setup.own_detector is None else self.setup.own_detector.to_json(),
            "objects": {
                name: {status: int(np.count_nonzero(found == status)) for status in OBJECT_STATUSES}
                for name, found in zip(self.setup.object_names, self.object_status.T, strict=False)
            },
        }

    def arrays(self) -> dict[str, np.ndarray]:
        """The content of `track.npz`."""
        return {
            "frame": self.frame,
            "joint_names": np.array(self.joint_names, dtype=np.str_),
            "joints_3d": self.joints_3d,
            "joints_2d": self.joints_2d,
            "camera_ids": np.array(self.camera_ids, dtype=np.str_),
            "object_names": np.array(self.setup.object_names, dtype=np.str_),
            "T_world_object": self.T_world_object,
            "object_status": self.object_status,
            "pose": self.pose,
            "status": self.status,
            "hand_names": np.array(self.setup.hand_names, dtype=np.str_),
            "hand_status": self.hand_status,
            "seconds": self.seconds,
        }

    def save(self, folder: Path) -> None:
        """Write `track.npz`, `summary.json`, `setup.json` and the models."""
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        self.setup.save(folder)
        self.chunk.save(folder / "frames.npz")
        save_arrays(folder / "track.npz", self.arrays())
        if self.views is not None:
            self.views.save(folder / VIEWS_FILE)
        temporary = folder / ".summary.json.part"
        temporary.write_text(json.dumps(self.summary(), indent=1))
        temporary.replace(folder / "summary.json")


def join_chunks(sequence: Sequence, setup: TrackSetup, chunks: Several[TrackChunk]) -> Track:
    """A track from the chunks of a run, in order."""
    chunk = TrackChunk.join(chunks)
    if np.any(np.diff(chunk.frame) != 1):
        raise TrackingError("The chunks of a track must follow one another without a gap.")
    joints, objects = [], []
    for pose in chunk.pose:
        posed = setup.scene.pose_at(pose)
        parts, motions = [np.zeros((0, 3))], [np.zeros((0, 4, 4))]
        for index, model in enumerate(setup.models):
            if model.hand or model.skeleton.num_bones > 1:
                parts.append(posed.landmarks(index))
            if not model.hand:
                motions.append(posed.T_world_model(index)[None])
        joints.append(np.concatenate(parts))
        objects.append(np.concatenate(motions))
    joints_3d = np.stack(joints)
    joints_2d = np.stack([[camera.project(points) for camera in sequence.cameras] for points in joints_3d])
    camera_ids = tuple(camera.id for camera in sequence.cameras)
    views = _compare_views(sequence, setup, chunk, joints_3d)
    return Track(setup, camera_ids, chunk, joints_3d, joints_2d, np.stack(objects), views)


def load_track(folder: Path) -> Track:
    """Read what `Track.save` wrote."""
    folder = Path(folder)
    arrays = load_arrays(folder / "track.npz", ("camera_ids", "joints_3d", "joints_2d", "T_world_object"))
    camera_ids = tuple(str(camera_id) for camera_id in arrays.pop("camera_ids"))
    views = ViewErrors.load(folder / VIEWS_FILE) if (folder / VIEWS_FILE).is_file() else None
    return Track(TrackSetup.load(folder), camera_ids, TrackChunk.load(folder / "frames.npz"), **arrays, views=views)


def _compare_views(sequence: Sequence, setup: TrackSetup, chunk: TrackChunk, joints_3d: Array) -> ViewErrors | None:
    """None unless the chunk tells what two colour cameras or more saw."""
    cameras = [sequence.camera(camera_id) for camera_id in setup.view_ids]
    numbers = [number for number, camera in enumerate(cameras) if camera.has_color]
    if len(numbers) < 2 or not chunk.seen.shape[1]:
        return None
    places = [setup.joint_names.index(f"{name}/{joint}") for name in setup.hand_names for joint in HAND_JOINTS]
    joints = joints_3d[:, places].reshape(len(joints_3d), len(setup.hand_names), len(HAND_JOINTS), 3)
    lost = chunk.hand_status == STATUSES.index("lost")
    return measure_views([cameras[number] for number in numbers], chunk.frame, chunk.seen[:, numbers], joints, lost)


def _median(values: Array) -> float | None:
    values = values[np.isfinite(values)]
    return round(float(np.median(values)), 4) if values.size else None
