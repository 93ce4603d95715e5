"""Canonical particle-swarm optimisation within bounds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np
import numpy.typing as npt

from benchmarks.baselines.swarm_options import SwarmOptions

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Bounds:
    """A box and how the first generation is strewn in it.

    Attributes:
        lower, upper: (D,) nothing outside is ever tried.
        spread: (D,) standard deviation of the first generation.
        reset: (K,) dimensions that may be re-initialised.
    """

    lower: Array
    upper: Array
    spread: Array
    reset: npt.NDArray[np.int64]


@dataclass(frozen=True)
class Found:
    """The best of a swarm.

    Attributes:
        place: (D,).
        cost: Its cost.
        history: Best cost after each generation that was begun.
        evaluations: Places that were tried.
    """

    place: Array
    cost: float
    history: tuple[float, ...]
    evaluations: int


def search_with_swarm(
    cost: Callable[[Array], float],
    start: Array,
    bounds: Bounds,
    options: SwarmOptions,
    rng: np.random.Generator,
    deadline: float | None = None,
) -> Found:
    """The place of least cost that a swarm strewn around a start finds.

    One particle begins at the start itself, so nothing worse is ever returned. A particle that leaves the box is put
    back on its border with its velocity kept.

    Args:
        cost: Of a place (D,).
        start: (D,) within the bounds, else moved there.
        bounds: The box, and how to strew.
        options: Particles, generations and pulls.
        rng: Where chance comes from.
        deadline: `perf_counter()` at which the search stops, within a generation too; one place is always tried.
    """
    start = np.clip(start, bounds.lower, bounds.upper)
    shape = (options.particles, len(start))
    places = np.clip(start + rng.normal(size=shape) * bounds.spread, bounds.lower, bounds.upper)
    places[0] = start
    velocities = np.zeros(shape)
    own, own_costs = places.copy(), np.full(options.particles, np.inf)
    best, best_cost = start, np.inf
    history: list[float] = []
    evaluations = 0
    for generation in range(options.generations):
        if generation > 0:
            toward_own, toward_best = rng.random(shape), rng.random(shape)
            velocities = options.constriction * (
                velocities
                + options.cognitive * toward_own * (own - places)
                + options.social * toward_best * (best - places)
            )
            places = np.clip(places + velocities, bounds.lower, bounds.upper)
            if options.reset_every and generation % options.reset_every == 0 and len(bounds.reset):
                _reset(places, bounds, options.reset_share, rng)
        is_late = False
        for particle in range(options.particles):
            if deadline is not None and evaluations and perf_counter() >= deadline:
                is_late = True
                break
            found = cost(places[particle])
            evaluations += 1
            if found < own_costs[particle]:
                own_costs[particle], own[particle] = found, places[particle]
        leader = int(np.argmin(own_costs))
        best, best_cost = own[leader].copy(), float(own_costs[leader])
        history.append(best_cost)
        if is_late:
            break
    return Found(best, best_cost, tuple(history), evaluations)


def _reset(places: Array, bounds: Bounds, share: float, rng: np.random.Generator) -> None:
    """Put one random dimension of a share of the places anywhere within its bounds, in place."""
    chosen = rng.permutation(len(places))[: round(share * len(places))]
    dimensions = rng.choice(bounds.reset, size=len(chosen))
    places[chosen, dimensions] = rng.uniform(bounds.lower[dimensions], bounds.upper[dimensions])
