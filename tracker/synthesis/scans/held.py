"""A green thing in the hand, as large as the grasp leaves room for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy.spatial import KDTree

from tracker.synthesis.scans.deform import PosedHand
from tracker.synthesis.scans.pose_list import HeldObject
from tracker.synthesis.scans.subject import BONES, Subject, load_surface
from tracker.synthesis.scans.tissue import vertex_normals

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

PRESS = 0.3e-3
"""Skin and object touch by so much, m."""

FARTHEST, GRID = 0.018, 3e-3
"""How far from where it starts places are tried, and their distance, m."""

LEAST_RADIUS = 3e-3
"""Of what is held, m; where there is less room, nothing is."""
ROD_HALF_LENGTH = 0.06
"""m."""
SEGMENTS = 48
"""Of a circle."""


@dataclass(frozen=True)
class ObjectMesh:
    """Vertices (V, 3) m and faces (F, 3), outwards; empty when there is no room."""

    vertices: Array
    faces: Ints


NOTHING = ObjectMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))


def place_object(subject: Subject, posed: PosedHand, held: HeldObject) -> ObjectMesh:
    """The object in a right hand, in the hand's frame: between thumb and fingertips or inside the curl of the fingers.

    Of the places on a grid around either, outside the skin, the one is taken that has most room and is not far;
    a rod lies along the knuckles, more or less.
    """
    knuckles = _joint(subject, posed, "index_proximal") - _joint(subject, posed, "little_proximal")
    normals = vertex_normals(posed.vertices, load_surface().faces)
    whole = KDTree(posed.vertices)
    steps = np.arange(-FARTHEST, FARTHEST + 1e-9, GRID)
    best, score, axis, room = np.zeros(3), 0.0, knuckles, 0.0
    for start in _find_starts(subject, posed):
        for along in [np.zeros(3)] if held.kind == "ball" else _tilted(knuckles):
            frame = np.eye(3) if held.kind == "ball" else _across(along)
            reach = posed.vertices[np.abs((posed.vertices - start) @ along) < ROD_HALF_LENGTH] @ frame.T
            grid = np.stack(np.meshgrid(*[steps] * len(frame), indexing="ij"), axis=-1).reshape(-1, len(frame))
            rooms = np.asarray(KDTree(reach).query(start @ frame.T + grid)[0])
            centers = start + grid @ frame
            nearest = np.asarray(whole.query(centers)[1])
            is_outside = np.einsum("nx,nx->n", centers - posed.vertices[nearest], normals[nearest]) > 0.0
            wanted = np.where(is_outside, np.minimum(rooms, held.radius), 0.0) - 0.4 * np.linalg.norm(grid, axis=1)
            first = int(np.argmax(wanted))
            if wanted[first] > score:
                best, score, axis, room = centers[first], float(wanted[first]), along, float(rooms[first])
    radius = min(held.radius, room + PRESS)
    if radius < LEAST_RADIUS:
        return NOTHING
    return _ball(best, radius) if held.kind == "ball" else _rod(best, radius, axis)


def _tilted(axis: Array) -> list[Array]:
    """Unit vectors near one."""
    axis = axis / np.linalg.norm(axis)
    first, second = _across(axis)
    tilts = [axis + a * first + b * second for a in (-0.25, 0.0, 0.25) for b in (-0.25, 0.0, 0.25)]
    return [tilt / np.linalg.norm(tilt) for tilt in tilts]


def _across(axis: Array) -> Array:
    """(2, 3) unit vectors square to one and to each other."""
    first = np.cross(axis, [0.0, 0.0, 1.0])
    first = first / np.linalg.norm(first)
    return np.stack([first, np.cross(axis, first)])


def _find_starts(subject: Subject, posed: PosedHand) -> tuple[Array, Array]:
    """(3,) between thumb and fingertips, and (3,) in the middle of the bent fingers."""
    tips = np.array([_pad(subject, posed, finger) for finger in ("index", "middle")])
    bent = [
        point
        for finger in ("index", "middle", "ring")
        for point in (
            *(_joint(subject, posed, f"{finger}_{segment}") for segment in ("proximal", "middle", "distal")),
            _pad(subject, posed, finger),
        )
    ]
    return 0.5 * _pad(subject, posed, "thumb") + 0.5 * tips.mean(axis=0), np.mean(bent, axis=0)


def _pad(subject: Subject, posed: PosedHand, finger: str) -> Array:
    bone = BONES.index(f"{finger}_distal")
    point = subject.joints[bone] + 0.6 * (subject.ends[bone] - subject.joints[bone])
    return posed.Ts[bone, :, :3] @ point + posed.Ts[bone, :, 3]


def _joint(subject: Subject, posed: PosedHand, name: str) -> Array:
    bone = BONES.index(name)
    return posed.Ts[bone, :, :3] @ subject.joints[bone] + posed.Ts[bone, :, 3]


def _ball(center: Array, radius: float) -> ObjectMesh:
    heights = np.cos(np.linspace(0.0, np.pi, SEGMENTS // 2 + 1))
    profile = np.stack([np.sqrt(1.0 - heights**2), heights], axis=1) * radius
    return _turn(center, profile, np.eye(3))


def _rod(center: Array, radius: float, along: Array) -> ObjectMesh:
    heights = np.linspace(ROD_HALF_LENGTH, -ROD_HALF_LENGTH, 40)
    profile = np.stack([np.full(len(heights), radius), heights], axis=1)
    caps = np.array([[0.0, heights[0]]]), np.array([[0.0, heights[-1]]])
    return _turn(center, np.concatenate([caps[0], profile, caps[1]]), np.concatenate([_across(along), along[None]]))


def _turn(center: Array, profile: Array, frame: Array) -> ObjectMesh:
    """What a profile (P, 2), radius and height from top to bottom, sweeps about the third axis of a frame."""
    around = np.linspace(0.0, 2.0 * np.pi, SEGMENTS, endpoint=False)
    ring = np.stack([np.cos(around), np.sin(around)], axis=1)
    points = np.concatenate([np.column_stack([radius * ring, np.full(SEGMENTS, height)]) for radius, height in profile])
    row, column = np.meshgrid(np.arange(len(profile) - 1), np.arange(SEGMENTS), indexing="ij")
    a, b = row * SEGMENTS + column, row * SEGMENTS + (column + 1) % SEGMENTS
    c, d = a + SEGMENTS, b + SEGMENTS
    faces = np.concatenate([np.stack([a, c, d], axis=2).reshape(-1, 3), np.stack([a, d, b], axis=2).reshape(-1, 3)])
    return ObjectMesh(center + points @ frame, faces)
