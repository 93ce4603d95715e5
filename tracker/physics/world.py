"""A Bullet world that holds a scene's hands and objects as convex hulls; one object moves, all else stands still."""

from __future__ import annotations

import weakref
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import TracebackType

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.model.scene import PosedScene, Scene
from tracker.physics.bullet import load_bullet
from tracker.physics.hulls import BoneHull, find_bone_hulls
from tracker.physics.protocol import GRAVITY, Protocol, StaticPlane

Array = npt.NDArray[np.float64]

MAX_PLANE_CONTACTS = 12

BLOCK = 1.0
"""m; half the side of the block that stands for a plane. Nothing falls through it in one step."""


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
        self.planes = tuple(planes)
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

    def place(self, posed: PosedScene, protocol: Protocol, reach: float = np.inf) -> None:
        """Put every hull where the pose has it, and the object at rest.

        Args:
            posed: Of this world's scene.
            protocol: Materials and time-step of the runs that follow.
            reach: Leave out still hulls whose bounding sphere is farther than this from the object's, m.
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
        self._protocol, self._skin = protocol, protocol.skin
        Rs, centers = self._poses(posed, [(self.moving, hull) for hull in self.object_hulls])
        weights = np.array([hull.volume for hull in self.object_hulls])
        self.centroid = weights @ centers / weights.sum()
        self._corners = np.concatenate(
            [c + h.vertices @ R.T for h, R, c in zip(self.object_hulls, Rs, centers, strict=True)]
        )
        self.radius = float(np.linalg.norm(self._corners - self.centroid, axis=1).max())
        for plane in self.planes:
            self._place_plane(plane, protocol)
        if self.hulls:
            self._place_hulls(posed, protocol, reach)
        self._place_object(Rs, centers, weights * (protocol.mass / weights.sum()), protocol)

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
        for plane in self.planes:
            height = (self._corners - np.array(plane.point)) @ np.array(plane.normal)
            on_plane = self._corners[height <= 2.0 * self._skin]
            if len(on_plane) > MAX_PLANE_CONTACTS:
                on_plane = on_plane[np.linspace(0, len(on_plane) - 1, MAX_PLANE_CONTACTS).astype(int)]
            corners.append(on_plane)
            normals.append(np.tile(plane.normal, (len(on_plane), 1)))
        none = [np.zeros((0, 3))]
        return np.concatenate(corners or none), np.concatenate(normals or none)

    def run(self, shifts: Mapping[int, Array] | None = None, give_up: float = np.inf) -> float:
        """Simulate from where everything was placed; the distance that the object's centroid has moved, m.

        Args:
            shifts: Still hulls to set aside first, by how much (3,), world, m.
            give_up: Stop as soon as the centroid is farther off than this, m: it will hardly come back.
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
        moved = 0.0
        for step in range(self._protocol.steps):
            bullet.stepSimulation(physicsClientId=client)
            if step + 1 == self._protocol.steps or (step % 5 == 4 and give_up < np.inf):
                moved = self._displacement()
                if moved > give_up:
                    break
        return moved

    def _displacement(self) -> float:
        position, turn = self._bullet.getBasePositionAndOrientation(self._object, physicsClientId=self._client)
        start, start_turn = self._object_home
        turned = Rotation.from_quat(turn) * Rotation.from_quat(start_turn).inv()
        now = np.array(position) + turned.apply(self.centroid - np.array(start))
        return float(np.linalg.norm(now - self.centroid))

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

    def _place_plane(self, plane: StaticPlane, protocol: Protocol) -> None:
        """A large block below the plane."""
        normal = np.array(plane.normal)
        turn = Rotation.align_vectors(normal[None], [[0.0, 0.0, 1.0]])[0]
        center = np.array(plane.point) - BLOCK * normal
        self._add(self._block_shape, center.tolist(), turn.as_quat().tolist(), protocol.static_friction)

    def _place_hulls(self, posed: PosedScene, protocol: Protocol, reach: float) -> None:
        Rs, centers = self._poses(posed, self.hulls)
        radii = np.array([np.linalg.norm(hull.vertices, axis=1).max() for _, hull in self.hulls])
        apart = np.linalg.norm(centers - self.centroid, axis=1) - radii - self.radius
        quaternions_xyzw = Rotation.from_matrix(Rs).as_quat().tolist()
        for index in np.flatnonzero(apart <= reach):
            home = centers[index].tolist(), quaternions_xyzw[index]
            body = self._add(self._shapes[index], *home, protocol.friction)
            self._bodies[int(index)], self._home[int(index)] = body, home

    def _add(self, shape: int, position: list[float], turn_xyzw: list[float], friction: float) -> int:
        bullet, client = self._bullet, self._client
        body = bullet.createMultiBody(0.0, shape, -1, position, turn_xyzw, physicsClientId=client)
        bullet.changeDynamics(
            body,
            -1,
            lateralFriction=friction,
            restitution=0.0,
            collisionMargin=self._skin,
            physicsClientId=client,
        )
        self._placed.append(body)
        return body

    def _place_object(self, Rs: Array, centers: Array, masses: Array, protocol: Protocol) -> None:
        """One body; the hulls but the first hang on it by fixed joints."""
        bullet, client, links = self._bullet, self._client, len(centers) - 1
        relative = np.einsum("ji,njk->nik", Rs[0], Rs[1:])
        offsets = (centers[1:] - centers[0]) @ Rs[0]
        turns = Rotation.from_matrix(relative).as_quat().tolist() if links else []
        self._object_home = centers[0].tolist(), Rotation.from_matrix(Rs[0]).as_quat().tolist()
        self._object = bullet.createMultiBody(
            float(masses[0]),
            self._object_shapes[0],
            -1,
            *self._object_home,
            linkMasses=masses[1:].tolist(),
            linkCollisionShapeIndices=self._object_shapes[1:],
            linkVisualShapeIndices=[-1] * links,
            linkPositions=offsets.tolist(),
            linkOrientations=turns,
            linkInertialFramePositions=[[0.0] * 3] * links,
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0]] * links,
            linkParentIndices=[0] * links,
            linkJointTypes=[bullet.JOINT_FIXED] * links,
            linkJointAxis=[[0.0, 0.0, 1.0]] * links,
            physicsClientId=client,
        )
        self._placed.append(self._object)
        for link, (hull, mass) in enumerate(zip(self.object_hulls, masses.tolist(), strict=True), start=-1):
            # Said outright: what Bullet works out itself depends on the skin that the shape happened to have before.
            bullet.changeDynamics(
                self._object,
                link,
                localInertiaDiagonal=(mass * hull.inertia_per_mass).tolist(),
                lateralFriction=protocol.friction,
                restitution=protocol.restitution,
                linearDamping=0.0,
                angularDamping=0.0,
                collisionMargin=self._skin,
                physicsClientId=client,
            )
