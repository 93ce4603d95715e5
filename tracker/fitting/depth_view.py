"""The depth image of one of several cameras as a term of the objective."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from tracker.fitting.frame_fit import look_at
from tracker.fitting.objective import Objective, thin_terms
from tracker.model.scene import PosedScene
from tracker.observation import Observation
from tracker.terms.residual import JointResidual, Term


@dataclass(frozen=True)
class DepthView:
    """The terms of a depth image, [T16] Eq. 5, of a camera that is one of several: their sum over cameras, as Eq. 19.

    The scene is drawn as this camera sees it, whatever else the frame is fitted to.

    Attributes:
        observation: What the camera saw.
        terms: Those of depth.
    """

    observation: Observation
    terms: dict[str, Term]

    @property
    def weight(self) -> float:
        """Each term has its own."""
        return 1.0

    def find(self, posed: PosedScene, context: object = None) -> JointResidual:
        """Look for the correspondences of all terms in this camera's image."""
        own = look_at(posed, self.observation)
        return JointResidual({name: term.find(posed, own) for name, term in self.terms.items()})

    @classmethod
    def of(cls, observation: Observation, share: float) -> DepthView:
        """With the usual terms of depth, each at this share of its weight."""
        terms: dict[str, Any] = dict(Objective().terms)
        return cls(observation, {name: replace(term, weight=share * term.weight) for name, term in terms.items()})

    def coarse(self) -> DepthView:
        return DepthView(self.observation, thin_terms(self.terms))
