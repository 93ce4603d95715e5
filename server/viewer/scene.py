"""The viser scene of one session: cloud, meshes, skeleton and correspondences of one frame at a time."""

from __future__ import annotations

import contextlib
import io
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
import viser
from viser import _messages

from server.viewer.layers import Layers, joint_colors, term_color

if TYPE_CHECKING:
    from tracker import Camera, FrameView

HAND_SPAN = 0.24
"""Height of what the first view shows at the distance of the hand, m."""

POINT_SIZE = 0.0008
"""m; less than the spacing of a depth sensor's points at arm's length, so that the mesh shows between them."""


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
        self._handles: dict[str, Any] = {}
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
            shown = {
                *self._show_cloud(view, layers.cloud),
                *self._show_meshes(view, layers.mesh),
                *self._show_skeleton(view, layers.skeleton),
                *self._show_correspondences(view, layers),
            }
            for name, handle in self._handles.items():
                handle.visible = name in shown
        self.server.flush()

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

    def _show_cloud(self, view: FrameView, visible: bool) -> set[str]:
        if not visible or len(view.cloud) == 0:
            return set()
        self._update(
            "/cloud",
            lambda: self.server.scene.add_point_cloud(
                "/cloud",
                view.cloud,
                view.colors,
                point_size=POINT_SIZE,
                point_shape="circle",
                point_shading="flat",
                precision="float32",
            ),
            points=view.cloud,
            colors=view.colors,
        )
        return {"/cloud"}

    def _show_meshes(self, view: FrameView, visible: bool) -> set[str]:
        if not visible:
            return set()
        for model in view.models:
            name = f"/mesh/{model.name}"
            self._update(
                name,
                lambda name=name, model=model: self.server.scene.add_mesh_simple(
                    name,
                    model.vertices,
                    model.faces,
                    color=model.color,
                    opacity=0.85,
                    side="double",
                    cast_shadow=False,
                ),
                vertices=model.vertices,
            )
        return {f"/mesh/{model.name}" for model in view.models}

    def _show_skeleton(self, view: FrameView, visible: bool) -> set[str]:
        shown = set()
        for model in view.models if visible else ():
            if len(model.joints) == 0:
                continue
            colors = joint_colors(model)
            name = f"/skeleton/{model.name}"
            self._update(
                f"{name}/joints",
                lambda name=name, model=model, colors=colors: self.server.scene.add_point_cloud(
                    f"{name}/joints",
                    model.joints,
                    colors,
                    point_size=0.005,
                    point_shape="circle",
                    precision="float32",
                ),
                points=model.joints,
            )
            bones = model.joints[model.edges]
            self._show_segments(f"{name}/bones", bones, colors[model.edges[:, 1]], thickness=0.0022)
            shown |= {f"{name}/joints", f"{name}/bones"}
        return shown

    def _show_correspondences(self, view: FrameView, layers: Layers) -> set[str]:
        shown = set()
        for term, segments in view.correspondences.items():
            if layers.shows_term(term) and len(segments):
                colors = np.tile(np.array(term_color(term), dtype=np.uint8), (len(segments), 1))
                self._show_segments(f"/correspondences/{term}", segments, colors, thickness=0.0006)
                shown.add(f"/correspondences/{term}")
        return shown

    def _show_segments(
        self, name: str, segments: npt.NDArray[Any], colors: npt.NDArray[np.uint8], thickness: float
    ) -> None:
        """Draw (M, 2, 3) segments, world, m, in (M, 3) colours."""
        points = np.ascontiguousarray(segments, dtype=np.float32).reshape(-1, 2, 3)
        both_ends = np.repeat(colors[:, None, :], 2, axis=1)
        self._update(
            name,
            lambda: self.server.scene.add_line_segments(name, points, both_ends, thickness=thickness),
            points=points,
            colors=both_ends,
        )

    def _update(self, name: str, make: Any, **arrays: npt.NDArray[Any]) -> None:
        """Make the node the first time, assign its arrays afterwards."""
        if name not in self._handles:
            self._handles[name] = make()
            return
        for attribute, value in arrays.items():
            setattr(self._handles[name], attribute, value)
