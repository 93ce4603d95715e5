"""A Bullet world that holds a scene's hands and objects as convex hulls; one object moves, all else stands still."""

from __future__ import annotations

import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.capture.static_plane import StaticPlane
from tracker.model.scene import PosedScene, Scene
from tracker.physics.bullet import load_bullet
from tracker.physics.hulls import BoneHull, find_bone_hulls
from tracker.physics.moving_body import build_moving_body
from tracker.physics.near_hulls import HullPairs
from tracker.physics.protocol import GRAVITY, Protocol

Array = npt.NDArray[np.float64]

MAX_PLANE_CONTACTS = 12
"""Corners of the object that touch a plane; more of them say nothing new and cost time."""

BLOCK = 1.0
"""m; half the side of the block that stands for a plane. Nothing falls through it in one step."""

CHECKED = 5
"""Steps between two looks at where the object is."""

CAUTION = 3.0
"""The object counts as at rest if it would stay where it should even at this many times its present speed."""


@dataclass(frozen=True)
class Gap:
    """Where a still hull is nearest to the object.

    Attributes:
        hull: Place in `PhysicsWorld.hulls`.
        distance: Between the hulls, m; below 0 when they overlap.
        point: (3,) on the object's hull, world, m.
        normal: (3,) unit, from the object towards the still hull, world.
    """

    hull: int
    distance: float
    point: Array
    normal: Array


class PhysicsWorld:
    """Hulls of a scene in a Bullet client of their own; close it, or use it in a `with` statement.

    The hulls are built once. `place` puts bodies at a pose, anew each time, so that a simulation does not depend on the
    ones before it; `run` may then be called many times. An articulated object moves as one rigid body, its joints held.

    Args:
        scene: Hands and objects.
        moving: Index of the model that moves; the first that is no hand when left out.
        down: (3,) unit direction of gravity, world; +y of an upright OpenCV camera at the world's origin.
        planes: The static scene.
    """

    def __init__(
        self,
        scene: Scene,
        moving: int | None = None,
        down: Sequence[float] = (0.0, 1.0, 0.0),
        planes: Sequence[StaticPlane] = (),
    ) -> None:
        objects = [index for index, model in enumerate(scene.models) if model.hand is None]
        assert moving is not None or objects, "a scene without an object has nothing to simulate"
        self.scene = scene
        self.moving = objects[0] if moving is None else moving
        self.down = np.array(down, dtype=np.float64)
        self.planes = self._planes = tuple(planes)
        assert self.down.shape == (3,) and abs(float(np.linalg.norm(self.down)) - 1.0) < 1e-6
        self._bullet = load_bullet()
        self._client = self._bullet.connect(self._bullet.DIRECT)
        assert self._client >= 0, "Bullet has no client left: close worlds that are done with"
        self._finalizer = weakref.finalize(self, self._bullet.disconnect, self._client)
        self.hulls: list[tuple[int, BoneHull]] = [
            (index, hull)
            for index, model in enumerate(scene.models)
            if index != self.moving
            for hull in find_bone_hulls(model)
        ]
        self.object_hulls = sorted(find_bone_hulls(scene.models[self.moving]), key=lambda h: (-h.volume, h.bone))
        self._pairs = HullPairs([hull for _, hull in self.hulls], self.object_hulls)
        self._shapes = [self._shape(hull) for _, hull in self.hulls]
        self._object_shapes = [self._shape(hull) for hull in self.object_hulls]
        self._block_shape = self._bullet.createCollisionShape(
            self._bullet.GEOM_BOX, halfExtents=[BLOCK] * 3, physicsClientId=self._client
        )
        self._bodies: dict[int, int] = {}
        self._home: dict[int, tuple[list[float], list[float]]] = {}
        self._moved: set[int] = set()
        self._placed: list[int] = []
        self._object = -1
        self._protocol: Protocol | None = None
        self._corners = np.zeros((0, 3))
        self._object_home: tuple[list[float], list[float]] = [0.0] * 3, [0.0, 0.0, 0.0, 1.0]
        self._object_R = np.eye(3)
        self.centroid = np.zeros(3)
        self.radius = 0.0
        self._skin = 0.0

    def __enter__(self) -> PhysicsWorld:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def close(self) -> None:
        """Give the client back; a second call does nothing."""
        self._finalizer()

    def place(self, posed: PosedScene, protocol: Protocol, reach: float = np.inf, rests_within: float = 0.0) -> None:
        """Put every hull where the pose has it, and the object at rest.

        Args:
            posed: Of this world's scene.
            protocol: Materials and time-step of the runs that follow.
            reach: Leave out still hulls that are farther than this from the object, m; nothing that is simulated can
                touch them.
            rests_within: A plane that the object's lowest corner is above or below by no more than this, m, is set to
                where the object rests on it: depth tells neither of them so exactly.
        """
        assert posed.scene is self.scene
        bullet, client = self._bullet, self._client
        for body in self._placed:
            bullet.removeBody(body, physicsClientId=client)
        bullet.setPhysicsEngineParameter(
            fixedTimeStep=protocol.time_step,
            numSubSteps=protocol.substeps if protocol.substeps > 1 else 0,
            numSolverIterations=protocol.solver_iterations,
            deterministicOverlappingPairs=1,
            physicsClientId=client,
        )
        bullet.setGravity(*(GRAVITY * self.down), physicsClientId=client)
        self._bodies, self._home, self._moved, self._placed = {}, {}, set(), []
        if protocol.skin != self._skin:
            self._set_object_skin(protocol.skin)
        self._protocol, self._skin = protocol, protocol.skin
        Rs, centers = self._poses(posed, [(self.moving, hull) for hull in self.object_hulls])
        weights = np.array([hull.volume for hull in self.object_hulls])
        self.centroid = weights @ centers / weights.sum()
        self._corners = np.concatenate(
            [c + h.vertices @ R.T for h, R, c in zip(self.object_hulls, Rs, centers, strict=True)]
        )
        self.radius = float(np.linalg.norm(self._corners - self.centroid, axis=1).max())
        still_Rs, still_centers = self._poses(posed, self.hulls)
        near = self._pairs.find_near(still_Rs, still_centers, Rs, centers, reach)
        self._planes = tuple(self._set_under(plane, rests_within) for plane in self.planes)
        for plane in self._planes:
            self._place_plane(plane, protocol)
        self._place_hulls(still_Rs, still_centers, np.any(near, axis=1), protocol)
        is_near = np.any(near, axis=0) | bool(self.planes) | np.isinf(reach)
        self._place_object(Rs, centers, weights * (protocol.mass / weights.sum()), is_near, protocol)

    def find_gaps(self, within: float) -> tuple[Gap, ...]:
        """The still hulls not farther than `within`, m, from the object, as they were placed; nearest first."""
        gaps = []
        for index, body in self._bodies.items():
            points = self._bullet.getClosestPoints(
                self._object, body, max(within - 2.0 * self._skin, 0.0) + 1e-9, physicsClientId=self._client
            )
            if not points:
                continue
            nearest = min(points, key=lambda point: point[8])
            # Bullet's normal points from the second body to the first.
            normal = -np.array(nearest[7])
            gaps.append(Gap(index, nearest[8] + 2.0 * self._skin, np.array(nearest[5]) - self._skin * normal, normal))
        return tuple(sorted((gap for gap in gaps if gap.distance <= within), key=lambda gap: (gap.distance, gap.hull)))

    def find_plane_contacts(self) -> tuple[Array, Array]:
        """Corners (N, 3) of the object that lie on a plane of the static scene, m, and its normals (N, 3), world."""
        corners, normals = [], []
        for plane in self._planes:
            height = (self._corners - np.array(plane.point)) @ np.array(plane.normal)
            on_plane = self._corners[height <= 2.0 * self._skin]
            if len(on_plane) > MAX_PLANE_CONTACTS:
                on_plane = on_plane[np.linspace(0, len(on_plane) - 1, MAX_PLANE_CONTACTS).astype(int)]
            corners.append(on_plane)
            normals.append(np.tile(plane.normal, (len(on_plane), 1)))
        none = [np.zeros((0, 3))]
        return np.concatenate(corners or none), np.concatenate(normals or none)

    def run(self, shifts: Mapping[int, Array] | None = None, give_up: float = np.inf, calm_below: float = 0.0) -> float:
        """Simulate from where everything was placed; the distance that the object's centroid has moved, m.

        Args:
            shifts: Still hulls to set aside first, by how much (3,), world, m.
            give_up: Stop as soon as the centroid is farther off than this, m: it will hardly come back.
            calm_below: Stop as soon as the object is so slow that it will hardly come as far as this, m; the distance
                is then what it would come to at that pace. 0 takes all steps.
        """
        assert self._protocol is not None, "place a pose first"
        bullet, client, shifts = self._bullet, self._client, shifts or {}
        for index in sorted(self._moved | set(shifts)):
            position, turn = self._home[index]
            if index in shifts:
                position = [p + float(s) for p, s in zip(position, shifts[index], strict=True)]
            bullet.resetBasePositionAndOrientation(self._bodies[index], position, turn, physicsClientId=client)
        self._moved = set(shifts)
        position, turn = self._object_home
        bullet.resetBasePositionAndOrientation(self._object, position, turn, physicsClientId=client)
        bullet.resetBaseVelocity(self._object, [0.0] * 3, [0.0] * 3, physicsClientId=client)
        steps, is_watched = self._protocol.steps, give_up < np.inf or calm_below > 0.0
        offset, turned = np.zeros(3), np.eye(3)
        for step in range(1, steps + 1):
            bullet.stepSimulation(physicsClientId=client)
            if step == steps or (is_watched and step % CHECKED == 0):
                earlier_offset, earlier_turned = offset, turned
                offset, turned = self._motion()
                moved = float(np.linalg.norm(offset))
                if moved > give_up:
                    return moved
                ahead = (steps - step) / CHECKED
                to_come = ahead * float(np.linalg.norm(offset - earlier_offset))
                to_swing = ahead * self.radius * float(np.linalg.norm(turned - earlier_turned))
                if step > CHECKED and moved + CAUTION * (to_come + to_swing) < calm_below:
                    return moved + to_come
        return float(np.linalg.norm(offset))

    def _motion(self) -> tuple[Array, Array]:
        """How the object has moved since it was placed: its centroid (3,), m, and its rotation (3, 3), world."""
        position, turn_xyzw = self._bullet.getBasePositionAndOrientation(self._object, physicsClientId=self._client)
        R = np.reshape(self._bullet.getMatrixFromQuaternion(turn_xyzw), (3, 3))
        turned = R @ self._object_R.T
        start = np.array(self._object_home[0])
        return np.array(position) + turned @ (self.centroid - start) - self.centroid, turned

    def _shape(self, hull: BoneHull) -> int:
        shape = self._bullet.createCollisionShape(
            self._bullet.GEOM_MESH, vertices=hull.vertices.tolist(), physicsClientId=self._client
        )
        assert shape >= 0
        return shape

    def _poses(self, posed: PosedScene, hulls: Sequence[tuple[int, BoneHull]]) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and centres (N, 3) of hulls, world, m."""
        bones = [self.scene.bone_slices[model].start + hull.bone for model, hull in hulls]
        Ms = posed.Ms[bones]
        centers = np.array([hull.center for _, hull in hulls])
        return Ms[:, :, :3], np.einsum("nij,nj->ni", Ms[:, :, :3], centers) + Ms[:, :, 3]

    def _set_under(self, plane: StaticPlane, within: float) -> StaticPlane:
        """The plane, set to where the object just touches it if that is not farther than `within`, m."""
        height = float(((self._corners - np.array(plane.point)) @ np.array(plane.normal)).min())
        if abs(height) > within:
            return plane
        x, y, z = (np.array(plane.point) + height * np.array(plane.normal)).tolist()
        return StaticPlane((x, y, z), plane.normal)

    def _place_plane(self, plane: StaticPlane, protocol: Protocol) -> None:
        """A large block below the plane."""
        normal = np.array(plane.normal)
        turn = Rotation.align_vectors(normal[None], [[0.0, 0.0, 1.0]])[0]
        center = np.array(plane.point) - BLOCK * normal
        self._add(self._block_shape, center.tolist(), turn.as_quat().tolist(), protocol.static_friction)

    def _place_hulls(self, Rs: Array, centers: Array, is_near: npt.NDArray[np.bool_], protocol: Protocol) -> None:
        chosen = np.flatnonzero(is_near)
        turns_xyzw = Rotation.from_matrix(Rs[chosen]).as_quat().tolist() if len(chosen) else []
        for index, turn_xyzw in zip(chosen.tolist(), turns_xyzw, strict=True):
            home = centers[index].tolist(), turn_xyzw
            self._bodies[index] = self._add(self._shapes[index], *home, protocol.friction, protocol.spinning_friction)
            self._home[index] = home

    def _add(
        self, shape: int, position: list[float], turn_xyzw: list[float], friction: float, spinning: float = 0.0
    ) -> int:
        bullet, client = self._bullet, self._client
        body = bullet.createMultiBody(0.0, shape, -1, position, turn_xyzw, physicsClientId=client)
        bullet.changeDynamics(
            body,
            -1,
            lateralFriction=friction,
            spinningFriction=spinning,
            restitution=0.0,
            collisionMargin=self._skin,
            physicsClientId=client,
        )
        self._placed.append(body)
        return body

    def _place_object(
        self, Rs: Array, centers: Array, masses: Array, is_near: npt.NDArray[np.bool_], protocol: Protocol
    ) -> None:
        """One body; hulls hang on its base by fixed joints."""
        bullet, client = self._bullet, self._client
        body = build_moving_body(self.object_hulls, Rs, centers, masses, is_near)
        links, count = list(body.links), len(body.links)
        relative = np.einsum("ji,njk->nik", body.R, Rs[links])
        offsets = (centers[links] - body.center) @ body.R
        turns = Rotation.from_matrix(relative).as_quat().tolist() if links else []
        self._object_home = body.center.tolist(), Rotation.from_matrix(body.R).as_quat().tolist()
        self._object_R = body.R
        self._object = bullet.createMultiBody(
            body.mass,
            -1 if body.base < 0 else self._object_shapes[body.base],
            -1,
            *self._object_home,
            linkMasses=masses[links].tolist(),
            linkCollisionShapeIndices=[self._object_shapes[link] for link in links],
            linkVisualShapeIndices=[-1] * count,
            linkPositions=offsets.tolist(),
            linkOrientations=turns,
            linkInertialFramePositions=[[0.0] * 3] * count,
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]] * count,
            linkParentIndices=[0] * count,
            linkJointTypes=[bullet.JOINT_FIXED] * count,
            linkJointAxis=[[0.0, 0.0, 1.0]] * count,
            physicsClientId=client,
        )
        self._placed.append(self._object)
        inertias = [body.inertia, *(masses[link] * self.object_hulls[link].inertia_per_mass for link in links)]
        for link, inertia in enumerate(inertias, start=-1):
            # Said outright: what Bullet works out itself depends on the skin that the shape happened to have before.
            bullet.changeDynamics(
                self._object,
                link,
                localInertiaDiagonal=inertia.tolist(),
                lateralFriction=protocol.friction,
                spinningFriction=protocol.spinning_friction,
                restitution=protocol.restitution,
                linearDamping=0.0,
                angularDamping=0.0,
                physicsClientId=client,
            )

    def _set_object_skin(self, skin: float) -> None:
        """Give the object's shapes a skin, each as the base of a body of its own.

        Bullet takes a skin for the base of a body only; asked for a link's, it applies all of that call to the base.
        """
        bullet, client = self._bullet, self._client
        for shape in self._object_shapes:
            body = bullet.createMultiBody(0.0, shape, physicsClientId=client)
            bullet.changeDynamics(body, -1, collisionMargin=skin, physicsClientId=client)
            bullet.removeBody(body, physicsClientId=client)
