"""What the hand detector sees of the hands in several views at one moment."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.fitting.objective import Objective
from tracker.fitting.ray_agreement import ENOUGH, find_believed
from tracker.fitting.view_jumps import find_jumps
from tracker.landmarks import DetectedHand
from tracker.model.joints import HAND_JOINTS
from tracker.model.scene import PosedScene, Scene
from tracker.terms.marked_joints import MarkedJoints

Array = npt.NDArray[np.float64]

WRIST, MIDDLE_MCP = HAND_JOINTS.index("wrist"), HAND_JOINTS.index("middle_mcp")

REACH = 15.0
"""mm; a joint that far from the detector's place has a quarter of its pull, as with depth (`sighting.REACH`)."""

SUPPORTED = 11
"""Where four views or more confirm this many joints of a hand, only these pull from afar."""

HOLDS = 0.5
"""A view holds a hand whose joints lie so near to where it was seen there, `ViewHands.measure`."""

FOLLOWS = 0.8
"""A hand that is called lost is still followed from where it is while one view sees it this near."""


@dataclass(frozen=True)
class ViewHands:
    """The hands of a recording in the images of one moment.

    Attributes:
        cameras: C of them, with colour.
        hands: For each camera, by the name of the hand, what was seen in its image, px as recorded.
    """

    cameras: tuple[Camera, ...]
    hands: tuple[Mapping[str, DetectedHand], ...]

    def of_camera(self, camera_id: str) -> Mapping[str, DetectedHand]:
        """What was seen in a camera's image; nothing in one without colour."""
        return next(
            (hands for camera, hands in zip(self.cameras, self.hands, strict=True) if camera.id == camera_id), {}
        )

    def points(self, name: str) -> Array:
        """(21, C, 2) px as recorded; NaN in views that do not see the hand."""
        found = np.full((21, len(self.cameras), 2), np.nan)
        for view, hands in enumerate(self.hands):
            if name in hands:
                found[:, view] = hands[name].points
        return found

    def stack(self, names: tuple[str, ...], camera_ids: tuple[str, ...]) -> npt.NDArray[np.float32]:
        """(C, H, 21, 2) px as recorded of the named hands in the named cameras; NaN where a hand was not seen."""
        found = np.full((len(camera_ids), len(names), 21, 2), np.nan, dtype=np.float32)
        for place, camera_id in enumerate(camera_ids):
            hands = self.of_camera(camera_id)
            for row, name in enumerate(names):
                if name in hands:
                    found[place, row] = hands[name].points
        return found

    def count(self, name: str) -> int:
        """Views in which a hand was seen."""
        return sum(name in hands for hands in self.hands)

    def without(self, name: str, views: list[int]) -> ViewHands:
        """The same, with one hand not seen in some views."""
        kept = [
            {other: hand for other, hand in hands.items() if other != name or view not in views}
            for view, hands in enumerate(self.hands)
        ]
        return replace(self, hands=tuple(kept))

    def without_jumps(self, posed: PosedScene, followed: Mapping[int, str], fps: float) -> ViewHands:
        """The same without joints that are detected too far from where they are expected (`find_jumps`).

        Args:
            posed: Where they are expected.
            followed: Index among the scene's models and name of each hand that was there a frame ago.
            fps: Frames a second.
        """
        views = [dict(hands) for hands in self.hands]
        for model, name in followed.items():
            if self.count(name):
                jumps = find_jumps(posed.landmarks(model), self.cameras, [hands.get(name) for hands in views], fps)
                for hands, own in zip(views, jumps, strict=True):
                    if own.any():
                        points = np.where(own[:, None], np.nan, hands[name].points)
                        hands[name] = replace(hands[name], points=points)
        return replace(self, hands=tuple(views))

    def rays(self, scene: Scene, model: int, name: str, reach: float = REACH) -> MarkedJoints:
        """The viewing rays of one hand's joints, in all views together, without those that most others contradict.

        Where four views or more see a hand, a joint that a single one tells of does not pull from afar: one in ten is
        false in the noise of [T16] §4.4.1, and took its finger 65 mm along (benchmarks/results/rendered_views.md).
        """
        every = np.full((21, len(self.cameras), 3), np.nan)
        for view, (camera, hands) in enumerate(zip(self.cameras, self.hands, strict=True)):
            if name in hands:
                rays = camera.unproject(hands[name].points) @ camera.T_world_camera[:3, :3].T
                every[:, view] = rays / np.linalg.norm(rays, axis=1, keepdims=True)
        origins = np.array([camera.T_world_camera[:3, 3] for camera in self.cameras]).reshape(-1, 3)
        believed, supported = find_believed(origins, every)
        if reach > REACH and len(origins) > ENOUGH and np.count_nonzero(supported.any(axis=1)) >= SUPPORTED:
            believed = supported
        is_known = np.isfinite(every).all(axis=2) & believed
        if reach > REACH and len(origins) > ENOUGH:
            is_known &= (np.count_nonzero(is_known, axis=1) > 1)[:, None]  # nothing bears a lone ray out
        views, joints = np.nonzero(is_known.T)
        own = every[joints, views]
        ids = (scene.landmark_slices[model].start + joints).astype(np.int32)
        return MarkedJoints(ids, own, np.cross(origins[views], own), np.ones(len(ids)), reach=reach)

    def add_to(
        self, objective: Objective, scene: Scene, names: tuple[str, ...], reach: float = REACH, weight: float = 1.0
    ) -> Objective:
        """The objective with the joints of all views, the S of [T16] Eq. 19 (`Sightings.add_to` says what differs)."""
        terms = dict(objective.terms)
        for model, name in enumerate(names):
            if self.count(name):
                terms[f"joints_{name}"] = replace(self.rays(scene, model, name, reach), weight=weight)
        return replace(objective, terms=terms)

    def measure(self, posed: PosedScene, model: int, name: str) -> Array:
        """(C,) mean distance of a hand's joints from where each view saw them, in quarters of its palm's length.

        Each joint counts at most 1. NaN in views that do not see the hand.
        """
        joints = posed.landmarks(model)
        palm = 0.25 * float(np.linalg.norm(joints[MIDDLE_MCP] - joints[WRIST]))
        apart = np.full(len(self.cameras), np.nan)
        for view, (camera, hands) in enumerate(zip(self.cameras, self.hands, strict=True)):
            if name in hands:
                depth = float(np.median((joints - camera.T_world_camera[:3, 3]) @ camera.T_world_camera[:3, 2]))
                pixels = palm * camera.K[0, 0] / max(depth, 1e-6)
                off = np.linalg.norm(camera.project(joints) - hands[name].points, axis=1) / pixels
                apart[view] = float(np.mean(np.minimum(np.where(np.isfinite(off), off, 1.0), 1.0)))
        return apart
