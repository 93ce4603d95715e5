"""The objective of [T16] Eq. 5: which terms, and how their sum is linearised."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from tracker.model.scene import PosedScene
from tracker.terms.data_to_model import DataToModel
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.joint_prior import AnatomicalLimits, Bending, Regularization
from tracker.terms.model_to_data import ModelToData
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.residual import FrameContext, JointResidual, Residual, Term, Thinnable
from tracker.terms.silhouette import Silhouette
from tracker.terms.uncovered import Uncovered

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Objective:
    """Terms by name; any of them may be missing.

    Attributes:
        terms: Terms that find correspondences.
        anatomy: Joint limits, weighted by the number of correspondences.
        regularization: Pull towards the previous frame's angles, weighted likewise.
        bending: Even bends of objects that are chains, weighted likewise.
    """

    terms: dict[str, Term] = field(
        default_factory=lambda: {
            "model_to_data": ModelToData(weight=0.1),
            "data_to_surface": DataToSurface(),
            "data_to_model": DataToModel(weight=0.02),
            "silhouette": Silhouette(weight=0.03),
            "uncovered": Uncovered(),
        }
    )
    anatomy: AnatomicalLimits = field(default_factory=AnatomicalLimits)
    regularization: Regularization = field(default_factory=Regularization)
    bending: Bending = field(default_factory=Bending)

    @classmethod
    def wide(cls, reach: float, stiffness: float) -> Objective:
        """With matches as far as `reach`, m, for poses that are far off; `stiffness` weighs the regularization."""
        return cls(
            {
                "model_to_data": ModelToData(max_distance=reach, max_angle=60.0),
                "data_to_surface": DataToSurface(max_distance=reach, stride=2),
                "data_to_model": DataToModel(max_pixels=6),
                "silhouette": Silhouette(weight=0.5, stride=1),
            },
            regularization=Regularization(stiffness),
        )

    def coarse(self) -> Objective:
        """The same with fewer matches where terms can do with fewer, for iterations that only have to come near."""
        return replace(self, terms=thin_terms(self.terms))

    def find(self, posed: PosedScene, context: FrameContext | None) -> dict[str, Residual]:
        """Correspondences of every term at the current pose."""
        found: dict[str, Residual] = {}
        for name, term in self.terms.items():
            residual = term.find(posed, context)
            if isinstance(residual, JointResidual):
                found |= {f"{name}_{part}": own for part, own in residual.parts.items()}
            else:
                found[name] = residual
        return found

    def linearize(
        self, posed: PosedScene, residuals: dict[str, Residual], previous_pose: Array
    ) -> tuple[Array, Array, dict[str, float]]:
        """JᵀJ (D, D), Jᵀr (D,) and the cost of each term, mm², at a posed scene."""
        equations = NormalEquations.at(posed)
        costs: dict[str, float] = {}
        for name, residual in residuals.items():
            before = equations.cost
            residual.add_to(equations)
            costs[name] = equations.cost - before
        return self.complete(equations, costs, previous_pose)

    def complete(
        self, equations: NormalEquations, costs: dict[str, float], previous_pose: Array
    ) -> tuple[Array, Array, dict[str, float]]:
        """The same of a sum of the terms' correspondences, with limits, regularisation and bends added to it.

        Args:
            equations: The sum.
            costs: Of the terms in it.
            previous_pose: (D,).
        """
        posed = equations.posed
        JtJ, Jtr = equations.assemble()
        costs = dict(costs)
        scene, dofs = posed.scene, posed.scene.angle_dofs
        angles = posed.pose[dofs]
        anatomy = self.anatomy.linearize(angles, scene.lower[dofs], scene.upper[dofs])
        nearness = self.regularization.linearize(angles, previous_pose[dofs])
        for name, weight, (cost, gradient, curvature) in (
            ("anatomy", self.anatomy.weight, anatomy),
            ("regularization", self.regularization.weight, nearness),
        ):
            scale = weight * max(equations.count, 1)
            costs[name] = scale * float(cost)
            JtJ[dofs, dofs] += scale * curvature
            Jtr[dofs] += scale * gradient
        if len(scene.bends):
            own, before = scene.bends.T
            scale = self.bending.weight * max(equations.count, 1)
            cost, gradient, curvature = self.bending.linearize(posed.pose[own], posed.pose[before])
            costs["bending"] = scale * cost
            for rows, sign in ((own, scale), (before, -scale)):
                np.add.at(Jtr, rows, sign * gradient)
                np.add.at(JtJ, (rows, rows), scale * curvature)
            JtJ[own, before] -= scale * curvature
            JtJ[before, own] -= scale * curvature
        return JtJ, Jtr, costs


def thin_terms(terms: dict[str, Term]) -> dict[str, Term]:
    """The same terms, with fewer matches where they can do with fewer."""
    return {name: term.coarse() if isinstance(term, Thinnable) else term for name, term in terms.items()}
