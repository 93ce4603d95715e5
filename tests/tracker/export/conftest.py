"""A track of two hands, a bending tube and a rigid one, at poses of our choosing: no images, nothing tracked."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from tests.tracker.toys import tube
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence
from tracker.fitting.options import TrackOptions
from tracker.fitting.setup import TrackSetup
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.tracking.chunk import TrackChunk
from tracker.tracking.track import Track, join_chunks

FRAMES = 6
FIRST = 3
K = np.array([[500.0, 0.0, 319.5], [0.0, 500.0, 239.5], [0.0, 0.0, 1.0]])


@dataclass(frozen=True)
class Moved:
    """A track and the recording it is of."""

    sequence: Sequence
    track: Track


def make_moved(models: dict[str, ArticulatedModel]) -> Moved:
    """Random angles within the limits and roots that turn all the way round; the frame in the middle is lost."""
    behind = se3.exp(np.array([0.0, 0.0, 0.7, 0.0, 0.0, 0.0]))
    cameras = (RecordedCamera("cam0", 640, 480, K), RecordedCamera("b,1", 640, 480, K, T_world_camera=behind))
    sequence = Sequence(Path("nowhere"), "moved", 25.0, FIRST + FRAMES, cameras)
    setup = TrackSetup(tuple(models), tuple(models.values()), "cam0", TrackOptions())
    scene, rng = setup.scene, np.random.default_rng(11)
    poses = []
    for frame in range(FRAMES):
        pose = scene.rest_pose()
        pose[scene.angle_dofs] = rng.uniform(scene.lower[scene.angle_dofs], scene.upper[scene.angle_dofs])
        for index, where in enumerate(scene.pose_slices):
            turn = np.array([0.3 * index, 1.3, 0.2]) * frame
            T = se3.exp(np.r_[0.0, 0.0, 0.0, turn])
            T[:3, 3] = [0.1 * index, 0.02 * frame, 0.6]
            pose[where.start : where.start + 6] = se3.log(T)
        poses.append(pose)
    nothing = np.full(FRAMES, np.nan)
    chunk = TrackChunk(
        frame=np.arange(FIRST, FIRST + FRAMES),
        pose=np.stack(poses),
        status=np.array([0, 0, 1, 2, 0, 0], dtype=np.int8),
        seconds=np.full(FRAMES, 0.01),
        depth_residual_mm=nothing,
        silhouette_iou=nothing,
        score=nothing,
        iterations=np.full(FRAMES, 10),
        cost_names=np.array([], dtype=np.str_),
        costs=np.zeros((FRAMES, 0)),
        stage_names=np.array([], dtype=np.str_),
        stages=np.zeros((FRAMES, 0)),
    )
    return Moved(sequence, join_chunks(sequence, setup, [chunk]))


@pytest.fixture(scope="session")
def moved() -> Moved:
    models = {side: default_hand(side) for side in ("right", "left")}
    return make_moved({**models, "rope": tube(bones=3), "ball": tube(bones=1)})


@pytest.fixture(scope="session")
def only_ball() -> Moved:
    """A rigid object without a hand."""
    return make_moved({"ball": tube(bones=1)})
