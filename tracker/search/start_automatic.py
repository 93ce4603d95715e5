"""Find a hand in a depth image without any annotation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.finger_search import curl_fingers, measure_curl, search_fingers
from tracker.fitting.frame_fit import draw, fit_from_afar
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.objective import Objective
from tracker.fitting.quality import Quality
from tracker.fitting.region import region_around, whole_image
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import Scene
from tracker.observation import Observation, Preprocessing, Region, observe
from tracker.search.palm_candidates import PalmCandidate, find_palm_candidates

Array = npt.NDArray[np.float64]

REACH = 0.22
"""A hand's pixels are this near to its palm, m."""

MIN_PIXELS = 50
"""Fewer hand pixels than this are no hand."""

SCORED_PIXELS = 1200
"""About this many hand pixels are enough to compare bends of a finger."""

EDGE_ON = 1.0 - 1e-9
"""Cosine above which a surface faces aside, and turns of a palm on it are counted from the image's other axis."""

SOFT = 0.01
"""Weight of the regularization once a hypothesis is aligned: half of what a followed hand has."""


@dataclass(frozen=True)
class Search:
    """How widely to search.

    Attributes:
        candidates: Places where a palm could be.
        turns: Directions of the fingers in the palm's plane.
        curls: Shares of the fingers' flexion tried, 0 open.
        likely: Merit below the best hypothesis at which one is still fitted rigidly.
        rigid: At most so many of those are fitted rigidly.
        rough: Of those, fitted with their fingers on the coarse image.
        bent: Of those, given a search of single fingers; with none, fingers are left to who follows the hand.
        fine: Of those, fitted on the fine image.
        width: Columns of the coarse image.
        nearness: Merit lost per metre of depth: what is captured is usually held out.
        openness: Merit lost by a fist against an open hand: a forearm can pass for a fist.
    """

    candidates: int = 8
    turns: int = 16
    curls: tuple[float, ...] = (0.0, 0.45)
    likely: float = 0.25
    rigid: int = 100
    rough: int = 24
    bent: int = 8
    fine: int = 4
    width: int = 160
    nearness: float = 0.5
    openness: float = 0.2

    def stride(self, camera: Camera) -> int:
        """Step in px between the pixels of the coarse image."""
        return max(1, camera.width // self.width)


STEP = Search(rigid=3, rough=2, bent=0, fine=1)
"""What a frame that follows another has time for, of a part of all hypotheses."""


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
    part: slice = slice(None),
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
        part: Of the hypotheses, those that are looked at.
    """
    search = search or Search()
    scene = Scene((model,))
    stride = search.stride(camera)
    coarse = observe(frame, camera, whole_image(camera, near, far), how, stride)
    judge = _Judge(scene, camera, search)
    hypotheses: list[tuple[float, Observation, Array]] = []
    for candidate in find_palm_candidates(coarse, search.candidates):
        region = _around(candidate, camera, near, far)
        place = observe(frame, camera, region, how, stride)
        poses = propose_poses(scene, candidate, camera, search)[part]
        hypotheses += [(judge.merit(place, pose), place, pose) for pose in poses]
    if not hypotheses:
        return None
    least = max(merit for merit, _, _ in hypotheses) - search.likely
    likely = sorted((one for one in hypotheses if one[0] > least), key=lambda one: -one[0])[: search.rigid]
    stiff, soft = Objective.wide(0.04, 2.0), Objective.wide(0.04, SOFT)
    rigid = [(place, fit_from_afar(scene, place, pose, stiff, 7)) for _, place, pose in likely]
    ranked = judge.rank(rigid)[: search.rough]
    settled = [(place, fit_from_afar(scene, place, pose, soft, 8)) for place, pose in ranked]
    best = judge.rank(settled)[: search.bent or search.fine]
    for _ in range(2 if search.bent else 0):
        best = [(seen, _bend(scene, judge, seen, pose)) for seen, pose in best]
    fine = [_fit_fine(frame, judge, how, pose) for _, pose in judge.rank(best)[: search.fine]]
    return max((one for one in fine if one), key=lambda one: one[0], default=(0.0, None))[1]


@dataclass(frozen=True)
class _Judge:
    """Compares poses of one hand.

    Attributes:
        scene: The hand.
        camera: The camera.
        search: What merit is lost for.
    """

    scene: Scene
    camera: Camera
    search: Search

    def merit(self, observation: Observation, pose: Array) -> float:
        """Score of a pose, less for what of the hand lies outside the image, for its depth and for closed fingers."""
        posed = self.scene.pose_at(pose)
        score = measure_quality(draw(posed, observation), observation).merit
        in_camera = se3.transform(self.camera.T_camera_world, posed.vertices)
        with np.errstate(divide="ignore", invalid="ignore"):
            columns = self.camera.K[0, 0] * in_camera[:, 0] / in_camera[:, 2] + self.camera.K[0, 2]
            rows = self.camera.K[1, 1] * in_camera[:, 1] / in_camera[:, 2] + self.camera.K[1, 2]
        inside = (columns > 0) & (columns < self.camera.width) & (rows > 0) & (rows < self.camera.height)
        in_image = float(np.mean(inside & (in_camera[:, 2] > 0)))
        closed = measure_curl(self.scene.models[0], pose[6:])
        return score * in_image**2 - self.search.nearness * float(in_camera[0, 2]) - self.search.openness * closed

    def rank(self, poses: list[tuple[Observation, Array]]) -> list[tuple[Observation, Array]]:
        """Poses, each with what it is to be compared with, by falling merit; the earlier of equals first."""
        return sorted(poses, key=lambda one: -self.merit(*one))


def propose_poses(scene: Scene, candidate: PalmCandidate, camera: Camera, search: Search) -> list[Array]:
    """Poses (D,) with the palm at a candidate, palm or back towards the camera, fingers in every direction."""
    model = scene.models[0]
    R_model_palm, palm = _palm_frame(model)
    view = candidate.point - camera.T_world_camera[:3, 3]
    normal = candidate.normal
    right, down = camera.T_world_camera[:3, 0], camera.T_world_camera[:3, 1]
    aside = right if abs(right @ normal) < EDGE_ON else down
    across = aside - normal * (aside @ normal)
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


def _fit_fine(frame: Frame, judge: _Judge, how: Preprocessing, pose: Array) -> tuple[float, Found] | None:
    """Merit and hand, fitted from a pose (D,) on the fine image; None where too little of it is seen."""
    scene, camera = judge.scene, judge.camera
    region = region_around(scene.pose_at(pose).vertices, camera)
    if region is None:
        return None
    fine = observe(frame, camera, region, how, max(1, judge.search.stride(camera) // 2))
    if fine.hand_count < MIN_PIXELS:
        return None
    pose = _bend(scene, judge, fine, pose) if judge.search.bent else pose
    pose = fit_from_afar(scene, fine, pose, Objective(), 20)
    return judge.merit(fine, pose), Found(pose, measure_quality(draw(scene.pose_at(pose), fine), fine))


def _bend(scene: Scene, judge: _Judge, seen: Observation, pose: Array) -> Array:
    """Search single fingers, then fit."""
    thin = seen.thin_to(SCORED_PIXELS)
    pose = search_fingers(pose, 0, scene.models[0], lambda trial: judge.merit(thin, trial))
    return fit_from_afar(scene, seen, pose, Objective.wide(0.03, SOFT), 8)


def _around(candidate: PalmCandidate, camera: Camera, near: float, far: float) -> Region:
    """The region within reach of a hand whose palm is at a candidate."""
    T = camera.T_camera_world
    x, y, z = T[:3, :3] @ candidate.point + T[:3, 3]
    column, row = camera.K[0, 0] * x / z + camera.K[0, 2], camera.K[1, 1] * y / z + camera.K[1, 2]
    reach = REACH * camera.K[0, 0] / z
    first_column, first_row = max(0, int(column - reach)), max(0, int(row - reach))
    return Region(
        first_row,
        first_column,
        max(1, min(camera.height, int(row + reach)) - first_row),
        max(1, min(camera.width, int(column + reach)) - first_column),
        max(near, z - REACH),
        min(far, z + REACH),
    )
