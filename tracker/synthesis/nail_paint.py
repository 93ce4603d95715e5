"""Finger nails in the colour images of rendered hands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.model.nails import find_nails
from tracker.synthesis.actor import Actor

Array = npt.NDArray[np.float64]
Color = tuple[float, float, float]

FOLD_FROM, FREE_FROM = 0.88, 0.72
"""The skin's fold begins so far from a nail's middle, the free edge so far towards the fingertip; 1 is the end."""


@dataclass(frozen=True)
class NailPaint:
    """Colours of nails: albedos, linear light.

    Attributes:
        plate: The nail on its bed.
        edge: Its free edge.
        fold: Share of the light that the fold around it gives back.
    """

    plate: Color = (0.80, 0.52, 0.44)
    edge: Color = (0.88, 0.80, 0.70)
    fold: float = 0.70

    def cover(
        self, actors: Sequence[Actor], owner: npt.NDArray[np.int64], places: Array, albedos: Array, spots: Array
    ) -> None:
        """Put the nails' colours into `albedos` (N, 3), and take the skin's spots out of `spots` (N,) there.

        Args:
            actors: Whose surfaces are seen.
            owner: (N,) the actor of each pixel.
            places: (N, 3) where it is on the actor at rest, m.
            albedos: Changed in place.
            spots: Changed in place.
        """
        for number, actor in enumerate(actors):
            if not actor.is_hand:
                continue
            own = np.flatnonzero(owner == number)
            for nail in find_nails(actor.model):
                away, along = nail.measure(places[own])
                on = own[away <= 1.0]
                away, along = away[away <= 1.0], along[away <= 1.0]
                is_edge = along > FREE_FROM
                albedos[on] = np.where(is_edge[:, None], self.edge, self.plate)
                spots[on] = np.where((away > FOLD_FROM) & ~is_edge, self.fold, 1.0)
