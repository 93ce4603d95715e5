"""Find a hand in a depth image without any annotation."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import Scene
from tracker.observation import Observation, Preprocessing, observe
from tracker.terms.data_to_model import DataToModel
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.model_to_data import ModelToData
from tracker.terms.silhouette import Silhouette
from tracker.tracking.finger_search import curl_fingers, search_fingers
from tracker.tracking.frame_fit import FitOptions, draw, fit_frame
from tracker.tracking.objective import Objective
from tracker.tracking.palm_candidates import PalmCandidate, find_palm_candidates
from tracker.tracking.quality import Quality, measure_quality
from tracker.tracking.region import region_around, whole_image

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Search:
    """How widely to search.

    Attributes:
        candidates: Places where a palm could be.
        turns: Directions of the fingers in the palm's plane.
        curls: Shares of the fingers' flexion tried, 0 open.
        rough: Hypotheses of each place refined on the coarse image.
        bent: Of those, given a search of single fingers.
        fine: Of all those, refined on the fine image.
        nearness: Score lost per metre behind the nearest place: what is captured is usually held out.
        width: Columns of the coarse image.
    """

    candidates: int = 8
    turns: int = 16
    curls: tuple[float, ...] = (0.0, 0.45)
    rough: int = 8
    bent: int = 2
    fine: int = 6
    nearness: float = 0.4
    width: int = 160


@dataclass(frozen=True)
class Found:
    """A hand that was found.

    Attributes:
        pose: (D,) of the scene that was given.
        quality: How well it explains the image.
    """

    pose: Array
    quality: Quality


def find_hand(
    frame: Frame,
    camera: Camera,
    model: ArticulatedModel,
    how: Preprocessing,
    near: float,
    far: float,
    search: Search | None = None,
) -> Found | None:
    """The pose of one hand that explains the frame best, or None where there is nothing like a hand.

    Palms are tried at every plausible place, both sides, all directions and two curls, drawn small and compared with
    the image; the best are fitted with wide correspondences, the best of those on the fine image.

    Args:
        frame: Undistorted frame with depth.
        camera: Its camera.
        model: The hand.
        how: Preprocessing.
        near: Least depth, m.
        far: Greatest depth, m.
        search: How widely to search.
    """
    search = search or Search()
    scene = Scene((model,))
    stride = max(1, camera.width // search.width)
    coarse = observe(frame, camera, whole_image(camera, near, far), how, stride)
    candidates = find_palm_candidates(coarse, search.candidates)
    if not candidates:
        return None
    judge = _Judge(scene, camera, search.nearness)
    eager = _Judge(scene, camera, 0.0)
    roughly = []
    for candidate in candidates:
        poses = eager.rank(coarse, propose_poses(scene, candidate, camera, search))[: search.rough]
        poses = [_refine(scene, coarse, pose, _wide_objective(0.04), 12) for pose in poses]
        for pose in eager.rank(coarse, poses)[: search.bent]:
            bent = search_fingers(pose, 0, model, lambda trial: eager.merit(coarse, trial))
            roughly.append(_refine(scene, coarse, bent, _wide_objective(0.03), 10))
    best: Found | None = None
    best_merit = -np.inf
    for pose in judge.rank(coarse, roughly)[: search.fine]:
        region = region_around(scene.pose_at(pose).vertices, camera)
        if region is None:
            continue
        fine_stride = max(1, stride // 2)
        fine = observe(frame, camera, region, how, fine_stride)
        if fine.hand_count < 50:
            continue
        pose = _refine(scene, fine, pose, _wide_objective(0.02), 20)
        pose = search_fingers(pose, 0, model, lambda trial, seen=fine: eager.merit(seen, trial))
        pose = _refine(scene, fine, pose, Objective(), 20)
        merit = judge.merit(fine, pose)
        if merit > best_merit:
            best = Found(pose, measure_quality(draw(scene.pose_at(pose), fine), fine))
            best_merit = merit
    return best


@dataclass(frozen=True)
class _Judge:
    """Compares poses of one hand.

    Attributes:
        scene: The hand.
        camera: The camera.
        nearness: Merit lost per metre of depth.
    """

    scene: Scene
    camera: Camera
    nearness: float

    def merit(self, observation: Observation, pose: Array) -> float:
        """Score of a pose, less what of the hand lies outside the image, less its depth."""
        posed = self.scene.pose_at(pose)
        score = measure_quality(draw(posed, observation), observation).score
        in_camera = se3.transform(self.camera.T_camera_world, posed.vertices)
        with np.errstate(divide="ignore", invalid="ignore"):
            columns = self.camera.K[0, 0] * in_camera[:, 0] / in_camera[:, 2] + self.camera.K[0, 2]
            rows = self.camera.K[1, 1] * in_camera[:, 1] / in_camera[:, 2] + self.camera.K[1, 2]
        inside = (columns > 0) & (columns < self.camera.width) & (rows > 0) & (rows < self.camera.height)
        return score * float(np.mean(inside & (in_camera[:, 2] > 0))) - self.nearness * float(in_camera[0, 2])

    def rank(self, observation: Observation, poses: list[Array]) -> list[Array]:
        """Poses by falling merit; the earlier of equals first."""
        merits = np.array([self.merit(observation, pose) for pose in poses])
        return [poses[i] for i in np.argsort(-merits, kind="stable")]


def propose_poses(scene: Scene, candidate: PalmCandidate, camera: Camera, search: Search) -> list[Array]:
    """Poses (D,) with the palm at a candidate, palm or back towards the camera, fingers in every direction."""
    model = scene.models[0]
    R_model_palm, palm = _palm_frame(model)
    view = candidate.point - camera.T_world_camera[:3, 3]
    normal = candidate.normal
    across = camera.T_world_camera[:3, 0] - normal * (camera.T_world_camera[:3, 0] @ normal)
    across /= np.linalg.norm(across)
    upward = np.cross(normal, across)
    poses = []
    for curl in search.curls:
        angles = curl_fingers(model, curl)
        for facing in (1.0, -1.0):
            for turn in range(search.turns):
                angle = 2.0 * np.pi * turn / search.turns
                forward = np.cos(angle) * across + np.sin(angle) * upward
                out = facing * normal
                R_world_palm = np.stack([forward, np.cross(out, forward), out], axis=1)
                T = np.eye(4)
                T[:3, :3] = R_world_palm @ R_model_palm.T
                center = candidate.point + 0.014 * view / np.linalg.norm(view)
                T[:3, 3] = center - T[:3, :3] @ palm
                poses.append(np.concatenate([se3.log(T), angles]))
    return poses


def _palm_frame(model: ArticulatedModel) -> tuple[Array, Array]:
    """Rotation (3, 3) of a palm frame (x to the fingers, z out of the palm or the back) and its centre (3,), model."""
    rest = Scene((model,)).pose_at(np.zeros(model.num_dofs)).landmarks(0)
    wrist, index, middle, little = (
        rest[HAND_JOINTS.index(name)] for name in ("wrist", "index_mcp", "middle_mcp", "little_mcp")
    )
    forward = (middle - wrist) / np.linalg.norm(middle - wrist)
    out = np.cross(forward, index - little)
    out /= np.linalg.norm(out)
    return np.stack([forward, np.cross(out, forward), out], axis=1), 0.45 * wrist + 0.55 * middle


def _wide_objective(reach: float) -> Objective:
    """The objective with matches as far as `reach`, m, for poses that are far off."""
    return Objective(
        terms={
            "model_to_data": ModelToData(max_distance=reach, max_angle=60.0),
            "data_to_surface": DataToSurface(max_distance=reach, stride=2),
            "data_to_model": DataToModel(max_pixels=6.0),
            "silhouette": Silhouette(weight=0.5, stride=1),
        },
        regularization=replace(Objective().regularization, weight=0.01),
    )


def _refine(scene: Scene, observation: Observation, pose: Array, objective: Objective, iterations: int) -> Array:
    options = FitOptions(iterations=iterations, damping=3e-2, max_turn=0.25, max_shift=0.02)
    return fit_frame(scene, observation, pose, pose, objective, options).pose
