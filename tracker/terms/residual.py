"""What a term returns: correspondences held fixed, and their linearisation."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene
from tracker.observation import Observation
from tracker.rendering import View
from tracker.terms.drawn_frame import DrawnFrame
from tracker.terms.normal_equations import NormalEquations

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class ResidualBlock:
    """A linearised residual, weight · |residual + jacobian · step|².

    Attributes:
        residual: (M,) mm.
        jacobian: (M, D) mm per unit of each degree of freedom.
        weights: (M,) of each row.
    """

    residual: Array
    jacobian: Array
    weights: Array

    @property
    def cost(self) -> float:
        return float(np.sum(self.weights * self.residual**2))


class Residual(Protocol):
    """Correspondences held fixed; a function of the pose only."""

    @property
    def count(self) -> int:
        """Correspondences."""
        ...

    def linearize(self, posed: PosedScene) -> ResidualBlock:
        """Residual and Jacobian at a pose, plainly."""
        ...

    def add_to(self, equations: NormalEquations) -> None:
        """Add JᵀJ and Jᵀr at `equations.posed` without building J: the hot path, equal to `linearize`."""
        ...

    def segments(self, posed: PosedScene) -> Array:
        """(M, 2, 3) from each model point to what it should meet, world, m: for the viewer."""
        ...


@dataclass(frozen=True)
class JointResidual:
    """Correspondences of several terms together.

    Attributes:
        parts: By the name of the term.
    """

    parts: dict[str, Residual]

    @property
    def count(self) -> int:
        return sum(part.count for part in self.parts.values())

    def linearize(self, posed: PosedScene) -> ResidualBlock:
        blocks = [part.linearize(posed) for part in self.parts.values()]
        return ResidualBlock(
            np.concatenate([block.residual for block in blocks]),
            np.concatenate([block.jacobian for block in blocks]),
            np.concatenate([block.weights for block in blocks]),
        )

    def add_to(self, equations: NormalEquations) -> None:
        for part in self.parts.values():
            part.add_to(equations)

    def segments(self, posed: PosedScene) -> Array:
        return np.concatenate([part.segments(posed) for part in self.parts.values()])


@dataclass(frozen=True)
class FrameContext:
    """What is known when correspondences are looked for.

    Attributes:
        view: The scene at the current pose as the camera sees it.
        observation: The same camera's image.
        vertex_labels: (V,) uint8 label bits a vertex may match.
        face_labels: (F,) uint8 label bits a face may match.
    """

    view: View
    observation: Observation
    vertex_labels: npt.NDArray[np.uint8]
    face_labels: npt.NDArray[np.uint8]

    @cached_property
    def drawn(self) -> DrawnFrame:
        """The arrays of all this, for kernels."""
        view, seen, posed = self.view, self.observation, self.view.posed
        return DrawnFrame(
            faces=posed.scene.arrays.faces,
            face_labels=self.face_labels,
            face_normals=view.face_normals,
            vertices=posed.vertices,
            vertex_normals=posed.normals,
            vertex_labels=self.vertex_labels,
            is_palm=posed.scene.is_palm,
            projected=view.projected,
            inverse_depth=view.inverse_depth,
            face=view.face,
            points=seen.points,
            normals=seen.normals,
            depth=seen.depth,
            labels=seen.labels,
            edges=seen.edges,
            nearest=seen.nearest_pixel,
            K=view.K,
            T=seen.T_world_camera,
        )


class Term(Protocol):
    """One summand of the objective, [T16] Eq. 5."""

    @property
    def weight(self) -> float: ...

    def find(self, posed: PosedScene, context: Any) -> Residual:
        """Look for correspondences at the current pose.

        Args:
            posed: The scene.
            context: The `FrameContext` of the depth image; None where there is none, for terms that need none because
                they bring what was seen, such as `MarkedJoints`.
        """
        ...


@runtime_checkable
class Thinnable(Protocol):
    """A term that can do with fewer matches."""

    def coarse(self) -> Term:
        """The same term with about a quarter of its matches."""
        ...
