"""The contours of a scene in several views, as one term: the edges of [T16] Eq. 19, summed over the cameras."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from tracker.fitting.map_views import map_views
from tracker.model.scene import PosedScene
from tracker.terms.contours import Contours
from tracker.terms.normal_equations import NormalEquations
from tracker.terms.residual import JointResidual, Residual


@dataclass(frozen=True)
class ViewResidual(JointResidual):
    """Correspondences of several views, whose sums are made side by side; the same bits for any number of threads.

    Attributes:
        threads: In which they are made.
    """

    threads: int = 1

    def add_to(self, equations: NormalEquations) -> None:
        def sum_up(part: Residual) -> NormalEquations:
            own = NormalEquations.at(equations.posed)
            part.add_to(own)
            return own

        for own in map_views(sum_up, self.parts.values(), self.threads):
            equations.add(own)


@dataclass(frozen=True)
class ViewContours:
    """`Contours` of each view.

    Attributes:
        views: By the camera's id.
        threads: In which the views are drawn and matched; the same bits for any number.
        weight: Of the whole, for each term has its own within.
    """

    views: Mapping[str, Contours]
    threads: int = 1
    weight: float = 1.0

    def find(self, posed: PosedScene, context: object = None) -> ViewResidual:
        """Match the contours in all views."""
        found = map_views(lambda own: own.find(posed), self.views.values(), self.threads)
        return ViewResidual(dict(zip(self.views, found, strict=True)), self.threads)

    def reaching(self, distance: float) -> ViewContours:
        """The same that go to edges so far away, m."""
        return replace(self, views={name: replace(own, max_distance=distance) for name, own in self.views.items()})
