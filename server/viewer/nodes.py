"""The nodes of a viser scene by name: made the first time, changed afterwards, hidden when a frame has none."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh
import viser

Color = tuple[int, int, int]

LIFT = 0.0004
"""m; enough for a patch not to flicker with the mesh below it."""


class SceneNodes:
    """Draws into one viser server. Call `begin` before a frame and `end` after it: what was not drawn is hidden."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._scene = server.scene
        self._handles: dict[str, Any] = {}
        self._drawn: set[str] = set()

    def begin(self) -> None:
        self._drawn = set()

    def end(self) -> None:
        for name, handle in self._handles.items():
            if handle.visible != (name in self._drawn):
                handle.visible = name in self._drawn

    def points(self, name: str, points: npt.NDArray[Any], colors: npt.NDArray[np.uint8], size: float) -> None:
        """Round points (N, 3), world, m, in (N, 3) colours; their size in m."""
        points = np.ascontiguousarray(points, dtype=np.float32)
        self._draw(
            name,
            lambda: self._scene.add_point_cloud(
                name, points, colors, point_size=size, point_shape="circle", point_shading="flat", precision="float32"
            ),
            points=points,
            colors=colors,
        )

    def segments(self, name: str, segments: npt.NDArray[Any], colors: npt.NDArray[np.uint8], thickness: float) -> None:
        """Segments (M, 2, 3), world, m, in (M, 3) colours; their thickness in m."""
        points = np.ascontiguousarray(segments, dtype=np.float32).reshape(-1, 2, 3)
        both_ends = np.repeat(colors[:, None, :], 2, axis=1)
        self._draw(
            name,
            lambda: self._scene.add_line_segments(name, points, both_ends, thickness=thickness),
            points=points,
            colors=both_ends,
        )

    def mesh(
        self, name: str, vertices: npt.NDArray[Any], faces: npt.NDArray[Any], color: Color, opacity: float | None
    ) -> None:
        """A mesh of one colour, (V, 3) world, m."""
        vertices, faces = np.asarray(vertices, dtype=np.float32), np.asarray(faces, dtype=np.uint32)
        self._draw(
            name,
            lambda: self._scene.add_mesh_simple(
                name, vertices, faces, color=color, opacity=opacity, side="double", cast_shadow=False
            ),
            vertices=vertices,
            faces=faces,
            opacity=opacity,
        )

    def triangles(self, name: str, corners: npt.NDArray[np.float32], color: Color) -> None:
        """Triangles (C, 3, 3), world, m, of one colour, lifted off the mesh that they are part of."""
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        faces = np.arange(3 * len(corners)).reshape(-1, 3)
        self.mesh(name, (corners + LIFT * normals[:, None]).reshape(-1, 3), faces, color, opacity=None)

    def colored_mesh(
        self, name: str, vertices: npt.NDArray[Any], faces: npt.NDArray[Any], colors: npt.NDArray[np.uint8]
    ) -> None:
        """A mesh with a colour (V, 3) at every vertex (V, 3), world, m."""
        opaque = np.concatenate([colors, np.full((len(colors), 1), 255, dtype=np.uint8)], axis=1)
        mesh = trimesh.Trimesh(vertices, faces, vertex_colors=opaque, process=False)
        file = io.BytesIO()
        mesh.export(file, file_type="glb", include_normals=True)
        content = file.getvalue()
        self._draw(
            name,
            lambda: self._scene.add_glb(name, content, cast_shadow=False, receive_shadow=False),
            glb_data=content,
        )

    def label(self, name: str, text: str, position: npt.NDArray[Any]) -> None:
        """Text at a place (3,), world, m, in front of everything."""
        self._draw(
            name,
            lambda: self._scene.add_label(
                name, text, position=position, font_screen_scale=0.8, anchor="bottom-center", depth_test=False
            ),
            text=text,
            position=np.asarray(position),
        )

    def _draw(self, name: str, make: Any, **values: Any) -> None:
        self._drawn.add(name)
        handle = self._handles.get(name)
        if handle is None:
            self._handles[name] = make()
            return
        for attribute, value in values.items():
            now = getattr(handle, attribute)
            if isinstance(value, np.ndarray) or now != value:
                setattr(handle, attribute, value)
