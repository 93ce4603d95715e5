"""One frame of a track as people look at it, and the overlay on the image."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.frame import Frame
from tracker.capture.sequence import Sequence
from tracker.detection import find_fingertips
from tracker.fitting.frame_fit import draw, find_residuals
from tracker.fitting.objective import Objective
from tracker.fitting.region import region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import find_sightings
from tracker.fitting.view_hands import ViewHands
from tracker.inspection.shown_cameras import ShownCamera, show_cameras
from tracker.inspection.shown_collisions import ShownCollisions, show_collisions
from tracker.inspection.shown_contacts import ShownContacts, show_contacts
from tracker.inspection.shown_detections import ShownDetection, show_detections
from tracker.inspection.shown_unknown import ShownUnknown, show_unknown
from tracker.inspection.surface_fit import measure_surface_fit
from tracker.inspection.view_aids import ViewAids
from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import HAND_EDGES
from tracker.model.scene import PosedScene
from tracker.observation import Observation, observe
from tracker.physics import find_support
from tracker.rendering import View, render_view
from tracker.tracking.as_written import compose_objective
from tracker.tracking.fit_views import compose_near
from tracker.tracking.hold import with_contacts
from tracker.tracking.see_hands import see_hands

Array = npt.NDArray[np.float64]

COLORS = {"right": (255, 146, 43), "left": (51, 154, 240), "object": (81, 207, 102)}
"""RGB of right hands, left hands and objects, the same everywhere in the studio."""

UNKNOWN_COLOR = (240, 101, 149)
"""RGB of what is neither hand nor an object that has a model."""

CLOUD_MARGIN = 0.6
"""The cloud is shown as far as this around the hands, m."""


@dataclass(frozen=True)
class ModelView:
    """A posed model.

    Attributes:
        name: `right`, `left` or the object's.
        color: RGB.
        vertices: (V, 3) float32 world, m.
        faces: (F, 3).
        joints: (J, 3) float32 world, m.
        edges: (E, 2) pairs of joints to connect.
    """

    name: str
    color: tuple[int, int, int]
    vertices: npt.NDArray[np.float32]
    faces: npt.NDArray[np.int32]
    joints: npt.NDArray[np.float32]
    edges: npt.NDArray[np.int32]


class FrameView:
    """What there is to see of a frame at a pose. Each thing is worked out when it is first asked for, and then kept.

    Attributes:
        aids: Of the track.
        T_world_camera: (4, 4) of the depth camera, or of the first of the colour cameras.
    """

    def __init__(
        self,
        frame: Frame,
        camera: Camera,
        pose: Array,
        aids: ViewAids,
        cameras: tuple[Camera, ...] = (),
        look_in_views: Callable[[PosedScene], tuple[Objective, ViewHands]] | None = None,
    ) -> None:
        self.aids = aids
        self.T_world_camera = camera.T_world_camera
        self._frame, self._camera, self._pose = frame, camera, pose
        self._cameras, self._look_in_views = cameras, look_in_views

    @property
    def cloud(self) -> npt.NDArray[np.float32]:
        """(N, 3) points of the depth image, world, m; none where colour cameras alone were tracked in."""
        return self._cloud[0]

    @property
    def colors(self) -> npt.NDArray[np.uint8]:
        """(N, 3) RGB of the cloud."""
        return self._cloud[1]

    @cached_property
    def models(self) -> tuple[ModelView, ...]:
        """Posed models."""
        setup, posed = self.aids.setup, self._posed
        return tuple(
            ModelView(
                name,
                _find_color(name, model),
                posed.vertices[setup.scene.vertex_slices[place]].astype(np.float32),
                model.faces.astype(np.int32),
                posed.landmarks(place).astype(np.float32),
                np.array(HAND_EDGES if model.hand else _bone_edges(model.skeleton.parents), dtype=np.int32).reshape(
                    -1, 2
                ),
            )
            for place, (name, model) in enumerate(zip(setup.names, setup.models, strict=True))
        )

    @cached_property
    def correspondences(self) -> dict[str, npt.NDArray[np.float32]]:
        """Name of each term of the run to its (M, 2, 3) segments from model to data, world, m."""
        tools, seen = self.aids.tools, self._seen
        if self._looked is not None:
            seen, objective = None, self._looked[0]
        elif seen is None:
            return {}
        elif self.aids.setup.options.is_as_written:
            objective = compose_objective(self.aids.setup, tools, seen)
        else:
            objective = tools.with_fingertips(seen)
            if tools.world is not None:
                support = find_support(tools.world, self._posed)
                objective = objective if support.is_stable else with_contacts(objective, support)
        found = find_residuals(self._posed, seen, objective)
        return {name: residual.segments(self._posed).astype(np.float32) for name, residual in found.items()}

    @cached_property
    def cameras(self) -> tuple[ShownCamera, ...]:
        """Every camera of the recording; those that are tracked in together with the rays of what they saw."""
        posed, names = self._posed, self.aids.setup.names
        hands = {name: posed.landmarks(place) for place, name in enumerate(names) if self.aids.setup.models[place].hand}
        return show_cameras(self._cameras, hands, None if self._looked is None else self._looked[1])

    @cached_property
    def detections(self) -> tuple[ShownDetection, ...]:
        """Fingertips found in the image, whether the run looked for them or not."""
        if self._seen is None or self._drawn is None:
            return ()
        found = find_fingertips(self.aids.setup.fingertip_detector, self._seen)
        return show_detections(self._posed, self._drawn, found, self.T_world_camera)

    @cached_property
    def collisions(self) -> ShownCollisions:
        """Parts that stand in each other."""
        return show_collisions(self._posed, self.aids.part_names)

    @cached_property
    def contacts(self) -> ShownContacts:
        """Whether the object stays, and which finger parts could hold it."""
        return show_contacts(self._posed, self.aids.world)

    @cached_property
    def unknown(self) -> ShownUnknown:
        """What is near the hands and neither hand nor a model: held things, sleeves, what hides the hand."""
        if self._seen is None or self._drawn is None:
            return ShownUnknown.nothing(self._camera.height, self._camera.width)
        return show_unknown(self._drawn, self._seen, self._camera.height, self._camera.width)

    @cached_property
    def surface_fit(self) -> tuple[npt.NDArray[np.float32], ...]:
        """For each model (V,) distance of its vertices to the data, m; NaN where the camera cannot see them."""
        distances = np.full(len(self._posed.vertices), np.nan, dtype=np.float32)
        if self._seen is not None and self._drawn is not None:
            distances = measure_surface_fit(self._posed, self._drawn, self._seen)
        return tuple(distances[where] for where in self.aids.setup.scene.vertex_slices)

    @cached_property
    def _posed(self) -> PosedScene:
        return self.aids.setup.scene.pose_at(np.asarray(self._pose, dtype=np.float64))

    @cached_property
    def _looked(self) -> tuple[Objective, ViewHands] | None:
        return None if self._look_in_views is None else self._look_in_views(self._posed)

    @cached_property
    def _seen(self) -> Observation | None:
        region, setup = region_around(self._posed.vertices, self._camera), self.aids.setup
        if region is None or self._frame.depth is None:
            return None
        expected = setup.project_hands(self._posed.pose, self._camera)
        sightings = find_sightings(setup.hand_detector, self._frame, self._camera, setup.hand_names, {}, expected)
        return observe(sightings.frame, self._camera, region, setup.preprocessing)

    @cached_property
    def _drawn(self) -> View | None:
        return None if self._seen is None else draw(self._posed, self._seen)

    @cached_property
    def _cloud(self) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.uint8]]:
        depth = self._frame.depth
        if depth is None:
            return np.zeros((0, 3), dtype=np.float32), np.zeros((0, 3), dtype=np.uint8)
        rows, columns = np.nonzero(depth)
        depths = depth[rows, columns].astype(np.float64)
        cloud = self._camera.lift(np.stack([columns, rows], axis=1), depths)
        near = np.ones(len(cloud), dtype=bool)
        if np.any(self._pose):
            near = np.linalg.norm(cloud - self._posed.vertices.mean(axis=0), axis=1) < CLOUD_MARGIN
        if self._frame.color is not None:
            return cloud[near].astype(np.float32), self._frame.color[rows, columns][near]
        shade = 90 + 140 * (1.0 - np.clip((depths[near] - depths[near].min(initial=9.0)) / 0.4, 0.0, 1.0))
        return cloud[near].astype(np.float32), np.repeat(shade[:, None], 3, axis=1).astype(np.uint8)


def describe_frame(
    sequence: Sequence, setup: TrackSetup, pose: Array, index: int, aids: ViewAids | None = None
) -> FrameView:
    """All that can be shown of a frame at a pose (D,); frames that are given the same `aids` share what is costly."""
    frame, camera = setup.read(sequence, index)
    aids = aids or ViewAids(setup, camera.T_world_camera)
    if not setup.view_ids:
        return FrameView(frame, camera, pose, aids, sequence.cameras)

    def look(posed: PosedScene) -> tuple[Objective, ViewHands]:
        views = setup.read_views(sequence, index)
        seen = see_hands(setup, views, posed, set())
        return compose_near(aids.tools.objective, setup, seen, views, posed), seen

    return FrameView(frame, camera, pose, aids, sequence.cameras, look)


def render_overlay(
    sequence: Sequence, setup: TrackSetup, pose: Array, index: int, camera_id: str
) -> npt.NDArray[np.uint8]:
    """(H, W, 4) RGBA: the shaded models on a transparent ground, as a camera of the recording sees them.

    Lens distortion is left out: the overlay fits the undistorted image.
    """
    camera = sequence.camera(camera_id)
    posed = setup.scene.pose_at(np.asarray(pose, dtype=np.float64))
    view = render_view(posed, camera.K, camera.T_world_camera, camera.height, camera.width)
    drawn = view.face >= 0
    image = np.zeros((camera.height, camera.width, 4), dtype=np.uint8)
    palette = np.array([_find_color(*one) for one in zip(setup.names, setup.models, strict=True)])
    faces = view.face[drawn]
    towards = -(view.face_normals[faces] @ camera.T_world_camera[:3, 2])
    shade = 0.35 + 0.65 * np.clip(towards, 0.0, 1.0)
    image[drawn, :3] = (palette[setup.scene.face_models[faces]] * shade[:, None]).astype(np.uint8)
    image[drawn, 3] = 165
    return image


def render_unknown(
    sequence: Sequence, setup: TrackSetup, pose: Array, index: int, camera_id: str
) -> npt.NDArray[np.uint8]:
    """(H, W, 4) RGBA: the mask of `FrameView.unknown` on a transparent ground; empty but in the run's depth camera."""
    camera = sequence.camera(camera_id)
    image = np.zeros((camera.height, camera.width, 4), dtype=np.uint8)
    if camera_id == setup.camera_id:
        image[describe_frame(sequence, setup, pose, index).unknown.mask] = (*UNKNOWN_COLOR, 165)
    return image


def _find_color(name: str, model: ArticulatedModel) -> tuple[int, int, int]:
    return COLORS[name if model.hand and name in COLORS else "object"]


def _bone_edges(parents: npt.NDArray[np.int64]) -> list[tuple[int, int]]:
    return [(int(parent), bone) for bone, parent in enumerate(parents) if parent >= 0]
