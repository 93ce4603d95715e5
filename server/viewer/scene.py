"""The viser scene of one session: the layers of one frame at a time."""

from __future__ import annotations

import contextlib
import io
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
import viser
from viser import _messages

from server.viewer.evidence import draw_evidence
from server.viewer.layers import Color, Layers, hand_colors, joint_colors, repeat, term_color
from server.viewer.nodes import SceneNodes

if TYPE_CHECKING:
    from tracker import Camera
    from tracker.inspection import FrameView

HAND_SPAN = 0.24
"""Height of what the first view shows at the distance of the hand, m; a hand half as far aside is out of it."""

POINT_SIZE = 0.0008
"""m; less than the spacing of a depth sensor's points at arm's length, so that the mesh shows between them."""


CAMERA_COLOR: Color = (148, 163, 184)

SOLID, SEE_THROUGH = 0.85, 0.35
"""Opacity of meshes, and where something on or in them is to be seen."""


class ViewerScene:
    """One viser server on a free port of the loopback, with no panel, no logo and no way to open a public tunnel."""

    def __init__(self, camera: Camera, focus: npt.NDArray[np.float64], dark: bool) -> None:
        """
        Args:
            camera: The recording's first camera; the view starts there.
            focus: (3,) world, m: what the first view looks at.
            dark: Dark ground.
        """
        with contextlib.redirect_stdout(io.StringIO()):
            self.server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        for request in (_messages.ShareUrlRequest, _messages.ShareUrlDisconnect):
            self.server._websock_server.unregister_handler(request)
        self._nodes = SceneNodes(self.server)
        self._focus = focus
        self.set_dark(dark)
        self._place_camera(camera, focus)

    @property
    def port(self) -> int:
        return self.server.get_port()

    def set_dark(self, dark: bool) -> None:
        self.server.gui.configure_theme(dark_mode=dark, show_logo=False, show_share_button=False)

    def show(self, view: FrameView, layers: Layers) -> None:
        """Bring the scene to a frame. A hidden layer is not sent."""
        with self.server.atomic():
            self._nodes.begin()
            if layers.cloud:
                self._draw_cloud(view)
            if layers.mesh and not layers.distances:
                self._draw_meshes(view, SEE_THROUGH if layers.is_inside_shown else SOLID)
            if layers.skeleton:
                self._draw_skeletons(view)
            if layers.correspondences:
                self._draw_correspondences(view, layers)
            if layers.cameras:
                self._draw_cameras(view)
            draw_evidence(self._nodes, view, layers)
            self._nodes.end()
        self.follow(np.concatenate([model.vertices for model in view.models]).mean(axis=0).astype(np.float64))
        self.server.flush()

    def follow(self, middle: npt.NDArray[np.float64]) -> None:
        """Turn every view by as much as the models' middle (3,) world, m, has moved, once it has left the first view.

        Views turn where they stand: seen from the recording's camera the depth image has no holes.
        """
        shift = middle - self._focus
        if np.linalg.norm(shift) < HAND_SPAN / 2.0:
            return
        self._focus = middle
        self.server.initial_camera.look_at = middle
        for client in self.server.get_clients().values():
            client.camera.look_at = client.camera.look_at + shift

    def close(self) -> None:
        with contextlib.redirect_stdout(io.StringIO()):
            self.server.stop()

    def _place_camera(self, camera: Camera, focus: npt.NDArray[np.float64]) -> None:
        """Start at the recording's camera, up as in its image, the hand filling the view."""
        T = camera.T_world_camera
        distance = max(float(np.linalg.norm(focus - T[:3, 3])), 0.05)
        of_camera = 2.0 * np.arctan2(camera.height / 2.0, camera.K[1, 1])
        self.server.scene.set_up_direction(tuple(-T[:3, 1]))
        start = self.server.initial_camera
        start.position = T[:3, 3]
        start.look_at = focus
        start.up = -T[:3, 1]
        start.fov = float(np.clip(2.0 * np.arctan2(HAND_SPAN / 2.0, distance), np.radians(8.0), of_camera))
        start.near = 0.01

    def _draw_cloud(self, view: FrameView) -> None:
        if len(view.cloud):
            self._nodes.points("/cloud", view.cloud, view.colors, POINT_SIZE)

    def _draw_meshes(self, view: FrameView, opacity: float) -> None:
        for model in view.models:
            self._nodes.mesh(f"/mesh/{model.name}", model.vertices, model.faces, model.color, opacity)

    def _draw_skeletons(self, view: FrameView) -> None:
        for model in view.models:
            if len(model.joints):
                colors = joint_colors(model)
                name = f"/skeleton/{model.name}"
                self._nodes.points(f"{name}/joints", model.joints, colors, size=0.005)
                bones = model.joints[model.edges]
                self._nodes.segments(f"{name}/bones", bones, colors[model.edges[:, 1]], thickness=0.0022)

    def _draw_cameras(self, view: FrameView) -> None:
        for camera in view.cameras:
            name = f"/cameras/{camera.name}"
            self._nodes.segments(f"{name}/outline", camera.outline, repeat(CAMERA_COLOR, 8), thickness=0.0015)
            self._nodes.label(f"{name}/label", camera.name, camera.outline[0, 0])
            if len(camera.rays):
                self._nodes.segments(f"{name}/rays", camera.rays, hand_colors()[camera.joints], thickness=0.0005)

    def _draw_correspondences(self, view: FrameView, layers: Layers) -> None:
        for term, segments in view.correspondences.items():
            if layers.shows_term(term) and len(segments):
                colors = repeat(term_color(term, layers.dark), len(segments))
                self._nodes.segments(f"/correspondences/{term}", segments, colors, thickness=0.0006)
