"""Find a rigid or articulated object in a depth image without a given place."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.fitting.frame_fit import draw, fit_from_afar
from tracker.fitting.object_quality import ObjectQuality, measure_object_quality
from tracker.fitting.objective import Objective
from tracker.fitting.region import depth_range, region_around, whole_image
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.scene import Scene
from tracker.observation import Observation, Preprocessing, observe
from tracker.rendering import View
from tracker.search.leave_out import leave_out, leave_out_forearms
from tracker.search.object_candidates import find_object_candidates
from tracker.search.start_rotations import propose_rotations, sample_surface, spread_rotations

Array = npt.NDArray[np.float64]

LEAST_IN_SIGHT = 0.4
"""With less than this share in sight an object is not found, only guessed."""

BEHIND = 0.005
"""A vertex so far behind the drawn surface is hidden by it, m."""

LEAST_SCORE = 0.45
"""So it is with a lower score: another thing of about the size reaches 0.4 to 0.7, the thing itself 0.9 in clean depth
and 0.5 to 0.7 where the sensor is 6 mm off on it (docs/objects.md)."""


STIFF = 2.0
"""Weight of the regularization in a search: joints of the object stay as they are."""


@dataclass(frozen=True)
class ObjectSearch:
    """How widely to search.

    Attributes:
        places: Where the object could be.
        rotations: Spread over all; those that make the object look the same are tried once.
        hypotheses: Places times rotations that are drawn at most; with more, the less likely places are left out.
        rough: Best hypotheses that are fitted on the coarse image.
        fine: Best of those, fitted on the fine image.
        width: Columns of the coarse image.
    """

    places: int = 40
    rotations: int = 48
    hypotheses: int = 800
    rough: int = 24
    fine: int = 4
    width: int = 160


@dataclass(frozen=True)
class FoundObject:
    """The best that a search for an object came to.

    Attributes:
        pose: (D,) of a scene of the object alone.
        quality: How well it explains the image.
        in_sight: Share of its side towards the camera that is in the image and hidden by nothing, itself included.
    """

    pose: Array
    quality: ObjectQuality
    in_sight: float

    @property
    def is_believable(self) -> bool:
        """Whether it may be taken for the object: what is mostly hidden explains too little to be sure."""
        is_seen = not (self.quality.is_hidden or self.quality.is_lost)
        return is_seen and self.quality.score >= LEAST_SCORE and self.in_sight >= LEAST_IN_SIGHT

    @property
    def merit(self) -> float:
        """To compare poses by: the score of what is in sight, less for what is not."""
        return self.quality.score * (0.5 + 0.5 * self.in_sight)


def find_object(
    model: ArticulatedModel,
    frame: Frame,
    camera: Camera,
    how: Preprocessing,
    others: list[tuple[ArticulatedModel, Array]],
    last: Array | None = None,
    search: ObjectSearch | None = None,
) -> FoundObject | None:
    """The best pose of an object in a frame, believable or not; None where there is nothing that could be one.

    What the other models explain is left out, and so are forearms, in sleeves or not; where colour tells hands from
    other things the hands stay in. The object is drawn small at all places that may be no hand, in all rotations that
    look different, and compared with the image; the best are fitted with wide correspondences, the best of those on the
    fine image.

    Args:
        model: The object.
        frame: Undistorted, with depth.
        camera: Its camera.
        how: Preprocessing.
        others: The other models of the scene that are placed, with their poses (D,); places near hands come first.
        last: (D,) pose in which it was seen last: places near it are looked at first, and its own rotation and angles
            are tried beside the others.
        search: How widely to search.
    """
    search, how = search or ObjectSearch(), replace(how, objects=True)
    depths = depth_range(frame)
    hands = [Scene((other,)).pose_at(pose).landmarks(0) for other, pose in others if other.hand]
    for other, pose in others:
        if not (other.hand and frame.color is not None and how.use_skin):
            frame = leave_out(frame, camera, Scene((other,)), pose, [0])
    frame = leave_out_forearms(frame, camera, hands)
    scene = Scene((model,))
    stride = max(1, camera.width // search.width)
    coarse = observe(frame, camera, whole_image(camera, *depths), how, stride)
    hypotheses = _propose(scene, coarse, np.concatenate([np.zeros((0, 3)), *hands]), last, search)
    drawn = [_judge(scene, coarse, camera, pose) for pose in hypotheses]
    rough = [
        fit_from_afar(scene, coarse, one.pose, Objective.wide(0.04, STIFF), 10) for one in _best(drawn, search.rough)
    ]
    fitted = [_judge(scene, coarse, camera, pose) for pose in rough]
    found: list[FoundObject] = []
    for pose in (one.pose for one in _best(fitted, search.fine)):
        region = region_around(scene.pose_at(pose).vertices, camera)
        if region is None:
            continue
        fine = observe(frame, camera, region, how)
        pose = fit_from_afar(scene, fine, pose, Objective.wide(0.02, STIFF), 10)
        pose = fit_from_afar(scene, fine, pose, Objective(), 10)
        found.append(_judge(scene, fine, camera, pose))
    return _best(found, 1)[0] if found else None


def _propose(scene: Scene, coarse: Observation, hands: Array, last: Array | None, search: ObjectSearch) -> list[Array]:
    """Poses (D,) that put the object's surface onto candidates, in all rotations; the likeliest places first."""
    model = scene.models[0]
    rest = scene.pose_at(scene.rest_pose() if last is None else last)
    T_last = rest.T_world_model(0)
    points = se3.transform(se3.inverse(T_last), sample_surface(rest.vertices[: len(model.vertices)], model.faces))
    middle = points.mean(axis=0)
    reach = np.linalg.norm(points - middle, axis=1)
    size = 2.0 * float(reach.max())
    narrow = 2.0 * float(np.sqrt(max(np.linalg.eigvalsh(np.cov((points - middle).T))[0], 0.0)))
    rotations = propose_rotations(points, spread_rotations(search.rotations))
    nearby = hands
    if last is not None:
        rotations = np.concatenate([T_last[None, :3, :3], rotations])
        nearby = se3.transform(T_last, middle)[None]
    count = max(1, min(search.places, search.hypotheses // len(rotations)))
    places = find_object_candidates(coarse, size, max(0.010, narrow), nearby, count)
    poses = []
    origin = coarse.T_world_camera[:3, 3]
    for place in places:
        ray = (place - origin) / np.linalg.norm(place - origin)
        for R in rotations:
            turned = (points - middle) @ R.T
            along = turned @ ray
            aside = np.linalg.norm(turned - along[:, None] * ray, axis=1)
            before = along[aside < 0.3 * reach.max()]
            T = np.eye(4)
            T[:3, :3] = R
            T[:3, 3] = place - min(float(before.min(initial=0.0)), 0.0) * ray - R @ middle
            poses.append(np.concatenate([se3.log(T), rest.pose[6:]]))
    return poses


def _judge(scene: Scene, seen: Observation, camera: Camera, pose: Array) -> FoundObject:
    posed = scene.pose_at(pose)
    view = draw(posed, seen)
    quality = measure_object_quality(view, seen, 0)
    not_hidden = min(1.0, quality.visible / max(np.count_nonzero(view.face >= 0), 1))
    return FoundObject(pose, quality, _share_in_sight(view, camera) * not_hidden)


def _share_in_sight(view: View, camera: Camera) -> float:
    """Share of the vertices facing the camera that lie in the image, and not behind other parts of the object."""
    posed = view.posed
    used = np.unique(posed.scene.arrays.faces)
    vertices, normals = posed.vertices[used], posed.normals[used]
    is_facing = np.einsum("vi,vi->v", normals, vertices - camera.T_world_camera[:3, 3]) < 0.0
    x, y, z = se3.transform(camera.T_camera_world, vertices[is_facing]).T
    z = np.where(z > 0.0, z, np.nan)
    columns, rows = camera.K[0, 0] * x / z + camera.K[0, 2], camera.K[1, 1] * y / z + camera.K[1, 2]
    in_image = (columns > 0) & (columns < camera.width) & (rows > 0) & (rows < camera.height)
    height, width = view.face.shape
    at_column = np.rint(np.nan_to_num(view.projected[used[is_facing], 0], nan=-1.0)).astype(np.int64)
    at_row = np.rint(np.nan_to_num(view.projected[used[is_facing], 1], nan=-1.0)).astype(np.int64)
    is_drawn = (at_column >= 0) & (at_column < width) & (at_row >= 0) & (at_row < height)
    nearest = view.depth[np.clip(at_row, 0, height - 1), np.clip(at_column, 0, width - 1)]
    is_behind = is_drawn & (nearest > 0.0) & (z > nearest + BEHIND)
    return float(np.mean(in_image & ~is_behind)) if len(z) else 0.0


def _best(found: list[FoundObject], count: int) -> list[FoundObject]:
    """Those with the highest merit; the earlier of equals first."""
    return sorted(found, key=lambda one: -one.merit)[:count]
