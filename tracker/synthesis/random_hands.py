"""Hands of random people in random poses before a camera, with or without things near them."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache

import numpy as np
import numpy.typing as npt
import trimesh

from tracker.capture.camera import Camera
from tracker.geometry import se3
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.joints import FINGERS, HAND_JOINTS
from tracker.model.scene import Scene
from tracker.model.shape import with_shape
from tracker.model.skeleton import Skeleton
from tracker.synthesis.actor import Actor
from tracker.synthesis.motion import FPS, find_closing
from tracker.synthesis.performance import Moment, Performance, render_moment
from tracker.synthesis.sensor import StructuredLight
from tracker.synthesis.shading import OBJECT_COLORS, SKIN, compute_cosines, shade
from tracker.synthesis.visibility import ABSENT, VISIBLE, find_visibility

Array = npt.NDArray[np.float64]

OWN_DEPTH = 0.020
"""A surface at most so far before or behind a joint can be the joint's own, m."""


@dataclass(frozen=True)
class RandomHands:
    """How random images are made.

    Attributes:
        nearest, farthest: Distance of the first hand from the camera, m.
        two_hands: Share of images with two hands.
        thing: Share of images with a ball, a box or a rod near a hand.
        any_side: Share of hands seen from any side; others show palm or back, more or less.
        shape_std: Of every shape parameter.
        joint_std: Of every joint angle about a smooth grip, rad.
        small_camera: Share of images from a camera of 320 x 240 px instead of 640 x 480.
        sensor: Noise of the depth camera.
    """

    nearest: float = 0.35
    farthest: float = 0.95
    two_hands: float = 0.35
    thing: float = 0.5
    any_side: float = 0.4
    shape_std: float = 1.0
    joint_std: float = 0.15
    small_camera: float = 0.3
    sensor: StructuredLight = field(default_factory=StructuredLight)


@dataclass(frozen=True)
class HandImage:
    """One image and its fingertips.

    Attributes:
        depth: (H, W) float32 m, 0 where there is no value.
        color: (H, W, 3) uint8 RGB.
        is_hand: (H, W) bool, pixels that show a hand.
        camera: That took it.
        tips: (T, 2) column and row, px, of the fingertips within the image.
        is_visible: (T,).
    """

    depth: npt.NDArray[np.float32]
    color: npt.NDArray[np.uint8]
    is_hand: npt.NDArray[np.bool_]
    camera: Camera
    tips: Array
    is_visible: npt.NDArray[np.bool_]


def render_random_image(how: RandomHands, rng: np.random.Generator) -> HandImage:
    """One image; the same `rng` makes the same."""
    performance = arrange_random_hands(how, rng)
    moment = render_moment(performance, 0)
    cosines = compute_cosines(performance, moment)
    depth = how.sensor.measure(moment.depth, cosines, performance.camera.K[0, 0], rng)
    visibility = find_visibility(performance, moment)
    is_tip = np.array([name.endswith("_tip") for name in performance.joint_names])
    kept = is_tip & (visibility != ABSENT)
    actor = np.where(moment.face >= 0, performance.face_actors[np.maximum(moment.face, 0)], -1)
    return HandImage(
        # Whole millimetres, as the sensor reports and recordings keep them.
        depth=np.rint(1000.0 * depth).astype(np.float32) * np.float32(0.001),
        color=shade(performance, moment, cosines, rng),
        is_hand=(actor >= 0) & (actor < len(performance.hands)),
        camera=performance.camera,
        tips=moment.pixels[kept],
        is_visible=(visibility[kept] == VISIBLE) & _shows_own_hand(performance, moment, actor)[kept],
    )


def _shows_own_hand(performance: Performance, moment: Moment, actor: npt.NDArray[np.int64]) -> npt.NDArray[np.bool_]:
    """(J,) whether the image shows a joint's own hand next to it: bodies placed by chance pass through each other.

    actor (H, W) is whose surface a pixel shows.
    """
    owners = [number for number, one in enumerate(performance.actors) for _ in one.joint_names]
    depths = se3.transform(performance.camera.T_camera_world, moment.joints)[:, 2]
    result = np.zeros(len(owners), dtype=np.bool_)
    for index, (owner, depth) in enumerate(zip(owners, depths, strict=True)):
        if depth <= 0.0:
            continue
        column, row = (int(value) for value in np.rint(np.clip(moment.pixels[index], -99.0, 99_999.0)))
        window = (slice(max(0, row - 2), max(0, row + 3)), slice(max(0, column - 2), max(0, column + 3)))
        result[index] = bool(np.any((actor[window] == owner) & (np.abs(moment.depth[window] - depth) < OWN_DEPTH)))
    return result


def arrange_random_hands(how: RandomHands, rng: np.random.Generator) -> Performance:
    """One moment of hands, and things near them, before a camera; hands come first among the actors."""
    if rng.random() < how.small_camera:
        focal, width, height = 240.0 * rng.uniform(0.9, 1.1), 320, 240
        distance = rng.uniform(how.nearest, 0.5 * (how.nearest + how.farthest))
    else:
        focal, width, height = 525.0 * rng.uniform(0.9, 1.1), 640, 480
        distance = rng.uniform(how.nearest, how.farthest)
    K = np.array([[focal, 0.0, 0.5 * (width - 1)], [0.0, focal, 0.5 * (height - 1)], [0.0, 0.0, 1.0]])
    aside = distance * np.array([width, height]) / focal * rng.uniform(-0.3, 0.3, 2)
    center = np.array([*aside, distance])
    sides = ["right", "left"] if rng.random() < 0.5 else ["left", "right"]
    actors = [_random_hand(sides[0], center, how, rng)]
    if rng.random() < how.two_hands:
        beside = rng.normal(size=3) * np.array([0.08, 0.05, 0.04])
        actors.append(_random_hand(sides[1], center + beside, how, rng))
    if rng.random() < how.thing:
        # Within the first hand's grip, or anywhere near.
        hand = actors[0]
        grip = hand.joints(0, hand.vertices(0)).mean(axis=0)
        near = grip + rng.normal(scale=0.01 if rng.random() < 0.6 else 0.06, size=3)
        actors.append(_random_thing(near, rng))
    return Performance("random hands", FPS, Camera("cam0", width, height, K), tuple(actors))


@cache
def _closing(side: str) -> Array:
    return find_closing(default_hand(side))


def _random_hand(side: str, center: Array, how: RandomHands, rng: np.random.Generator) -> Actor:
    """A hand whose middle knuckle is at `center` (3,) world, m."""
    model = default_hand(side)
    assert model.shape is not None
    betas = np.clip(how.shape_std * rng.normal(size=len(model.shape.names)), model.shape.lower, model.shape.upper)
    model = with_shape(model, betas)
    scene = Scene((model,))
    pose = scene.rest_pose()
    together = rng.uniform(-0.05, 0.9)
    for finger in range(len(FINGERS)):
        curl = np.clip(together + 0.35 * rng.normal(), -0.1, 1.0) if rng.random() < 0.8 else rng.uniform(-0.05, 1.0)
        pose[6:] += curl * _closing(side)[finger]
    pose[6:] += how.joint_std * rng.normal(size=len(pose) - 6)
    pose[6:] = np.clip(pose[6:], model.skeleton.lower, model.skeleton.upper)
    T = se3.exp(np.r_[np.zeros(3), _random_turn(rng)])
    if rng.random() >= how.any_side:
        T = _facing(rng)
    knuckle = scene.pose_at(pose).landmarks(0)[HAND_JOINTS.index("middle_mcp")]
    T[:3, 3] = center - T[:3, :3] @ knuckle
    pose[:6] = se3.log(T)
    return Actor(side, model, scene.pose_at(pose).Ms[None], SKIN)


def _random_turn(rng: np.random.Generator) -> Array:
    """(3,) rotation vector, uniform over all rotations."""
    q = rng.normal(size=4)
    q /= np.linalg.norm(q)
    q *= np.sign(q[0])
    sine = np.linalg.norm(q[1:])
    return 2.0 * np.arctan2(sine, q[0]) * q[1:] / max(float(sine), 1e-12)


def _facing(rng: np.random.Generator) -> Array:
    """(4, 4) palm or back towards the camera, tilted somewhat, turned any way in the image."""
    back = 1.0 if rng.random() < 0.5 else -1.0
    T = np.eye(4)
    T[:3, 0], T[:3, 2] = [0.0, -1.0, 0.0], [0.0, 0.0, back]
    T[:3, 1] = np.cross(T[:3, 2], T[:3, 0])
    tilt = se3.exp(np.r_[np.zeros(3), rng.normal(scale=0.5, size=2), 0.0])
    turn = se3.exp(np.r_[np.zeros(3), 0.0, 0.0, rng.uniform(-np.pi, np.pi)])
    return turn @ tilt @ T


def _random_thing(center: Array, rng: np.random.Generator) -> Actor:
    """A ball, a box or a rod at `center` (3,) world, m."""
    kind = rng.integers(3)
    if kind == 0:
        mesh = trimesh.creation.icosphere(subdivisions=2, radius=rng.uniform(0.015, 0.05))
    elif kind == 1:
        mesh = trimesh.creation.box(extents=rng.uniform(0.02, 0.08, 3))
    else:
        mesh = trimesh.creation.cylinder(radius=rng.uniform(0.005, 0.03), height=rng.uniform(0.1, 0.4), sections=16)
    skeleton = Skeleton(
        ("root",),
        np.array([-1]),
        np.eye(4)[None],
        np.zeros(0, dtype=np.int64),
        np.zeros((0, 3)),
        np.zeros(0),
        np.zeros(0),
    )
    model = ArticulatedModel(
        "thing",
        np.array(mesh.vertices, dtype=np.float64),
        np.array(mesh.faces, dtype=np.int64),
        np.ones((len(mesh.vertices), 1)),
        skeleton,
    )
    T = se3.exp(np.r_[np.zeros(3), _random_turn(rng)])
    T[:3, 3] = center
    return Actor("thing", model, T[None, None, :3], OBJECT_COLORS[int(rng.integers(len(OBJECT_COLORS)))])
