"""How well several people agree who marked the same joints without seeing each other's.

Every joint of every image that at least two people placed is one sample: person i marked x_i = μ + e_i, μ being the
place they all look for. Nothing else is known of μ, so it is estimated away:

- pooled spread: s² = Σ |x_i - x̄|² / Σ 2 (n - 1), the sums over samples of n people. The variance along an image axis,
  without bias for any number of people (dividing by n would make the deviation of four of them 13 % smaller, that of
  two 29 %);
- spread of one person: σ_i² of e_i, by restricted maximum likelihood. With m = Σ w x / Σ w, w = 1 / σ²:
  E |x_i - m|² / 2 = σ_i² - 1 / Σ w, which iterated as σ_i² = mean(|x_i - m|² / 2 + 1 / Σ w) is the EM algorithm. People
  who place a joint often or seldom count alike, and nobody's noise is spread over the others. Two people alone cannot
  be told apart: both get what they share.

[T16] Section 4.1 reports "the standard deviation of 4 annotators, which is 1.46 pixels" and does not say whether along
an axis or as a distance; here it is along an axis (`std_px`), and √2 times that as a distance (`radial_px`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import exp, lgamma, sqrt

import numpy as np

OKS_SIGMAS = np.array(
    (
        *(0.029, 0.022, 0.035, 0.037, 0.047, 0.026, 0.025, 0.024, 0.035, 0.018, 0.024),
        *(0.022, 0.026, 0.017, 0.021, 0.021, 0.032, 0.020, 0.019, 0.022, 0.031),
    )
)
"""COCO-WholeBody's constants of a hand, wrist to the tip of the little finger: Jin et al., Whole-Body Human Pose
Estimation in the Wild, ECCV 2020, and its evaluation code."""
EM_STEPS, EM_TOLERANCE = 500, 1e-6
Array = np.ndarray


@dataclass(frozen=True)
class Spread:
    """A standard deviation.

    Attributes:
        std_px: Along one image axis; None when nothing was placed twice.
        samples: Placed joints it comes from.
    """

    std_px: float | None
    samples: int


@dataclass(frozen=True)
class Bias:
    """Where a person marks, against the mean of the others: px, +x right, +y down."""

    x_px: float | None
    y_px: float | None


@dataclass(frozen=True)
class PairAgreement:
    """Two people: mean distance, object keypoint similarity, share of joints whose state they see differently."""

    first: int
    second: int
    joints: int
    mean_px: float | None
    oks: float | None
    state_disagreement: float | None


@dataclass(frozen=True)
class Agreement:
    """A people, P places (a hand in an image), 21 joints."""

    overall: Spread
    joints: tuple[Spread, ...]
    states: dict[str, Spread]
    places: tuple[Spread, ...]
    people: tuple[Spread, ...]
    people_joints: tuple[tuple[Spread, ...], ...]
    people_states: tuple[dict[str, Spread], ...]
    biases: tuple[Bias, ...]
    pairs: tuple[PairAgreement, ...]
    joint_disagreement: tuple[float | None, ...]


def measure_agreement(points: Array, is_marked: Array, is_counted: Array | None = None) -> Agreement:
    """Measure it.

    Args:
        points: (A, P, 21, 3) px and v (0 absent, 1 occluded, 2 visible), float64.
        is_marked: (A, P) whether the person marked the place at all, bool.
        is_counted: (A, P, 21) joints that count; the others are as if the person had not looked. All without it.
    """
    assert points.ndim == 4 and points.shape[2:] == (21, 3) and is_marked.shape == points.shape[:2]
    counted = is_marked[:, :, None] & (np.True_ if is_counted is None else is_counted)
    state = np.where(counted, points[..., 2], -1).astype(np.int64)
    placed = state > 0
    shared = placed & (placed.sum(axis=0) >= 2)
    xy = np.where(placed[..., None], points[..., :2], 0.0)
    squares, freedoms = _scatter(xy, shared)
    groups = _group_states(state, shared)
    everything = np.ones(shared.shape[1:], dtype=bool)
    joints = [_only_joint(everything, joint) for joint in range(21)]
    return Agreement(
        overall=_pool(squares, freedoms, shared, everything),
        joints=tuple(_pool(squares, freedoms, shared, mask) for mask in joints),
        states={name: _pool(squares, freedoms, shared, mask) for name, mask in groups.items()},
        places=tuple(
            _pool(squares[place], freedoms[place], shared[:, place], everything[place])
            for place in range(points.shape[1])
        ),
        people=_separate(xy, shared, everything),
        people_joints=tuple(zip(*(_separate(xy, shared, mask) for mask in joints), strict=True)),
        people_states=tuple(
            dict(zip(groups, spreads, strict=True))
            for spreads in zip(*(_separate(xy, shared, mask) for mask in groups.values()), strict=True)
        ),
        biases=_find_biases(xy, shared),
        pairs=_compare_pairs(xy, state, placed),
        joint_disagreement=_find_disagreement(state),
    )


def _scatter(xy: Array, shared: Array) -> tuple[Array, Array]:
    """(P, 21) sums of squared distances to the mean, px², and their degrees of freedom."""
    count = shared.sum(axis=0)
    mean = (xy * shared[..., None]).sum(axis=0) / np.maximum(count, 1)[..., None]
    squares = (((xy - mean) ** 2).sum(axis=-1) * shared).sum(axis=0)
    return squares, np.where(count >= 2, 2 * (count - 1), 0)


def _group_states(state: Array, shared: Array) -> dict[str, Array]:
    """(P, 21) samples that everybody who placed them calls visible, or occluded, or about which they differ."""
    is_shared = shared.any(axis=0)
    all_visible = is_shared & ((state == 2) | ~shared).all(axis=0)
    all_occluded = is_shared & ((state == 1) | ~shared).all(axis=0)
    return {
        "visible": all_visible,
        "occluded": all_occluded,
        "mixed": is_shared & ~all_visible & ~all_occluded,
    }


def _only_joint(everything: Array, joint: int) -> Array:
    mask = np.zeros_like(everything)
    mask[:, joint] = True
    return mask


def _pool(squares: Array, freedoms: Array, shared: Array, mask: Array) -> Spread:
    freedom = int(freedoms[mask].sum())
    if freedom == 0:
        return Spread(None, 0)
    # The root of an unbiased variance is a little too small when it comes from few samples (c4).
    correction = sqrt(2 / freedom) * exp(lgamma((freedom + 1) / 2) - lgamma(freedom / 2))
    return Spread(sqrt(float(squares[mask].sum()) / freedom) / correction, int(shared[:, mask].sum()))


def _separate(xy: Array, shared: Array, mask: Array) -> tuple[Spread, ...]:
    """Spread of each person over some samples, by EM.

    The samples in which the same people meet count through one matrix of scalar products, so that a step costs nothing
    however many they are.
    """
    people = len(shared)
    taken = shared & mask
    counts = taken.sum(axis=(1, 2))
    if not counts.any():
        return tuple(Spread(None, 0) for _ in range(people))
    columns = taken.reshape(people, -1)
    flat = xy.reshape(people, -1, 2)
    patterns, which = np.unique(columns[:, columns.any(axis=0)].T, axis=0, return_inverse=True)
    samples = flat[:, columns.any(axis=0)]
    meetings: list[tuple[Array, Array, int]] = []
    for number, pattern in enumerate(patterns):
        members = np.flatnonzero(pattern)
        found = samples[np.ix_(members, np.flatnonzero(which.ravel() == number))]
        centred = found - found.mean(axis=0)
        meetings.append((members, np.einsum("isc,jsc->ij", centred, centred) / 2, found.shape[1]))
    total = sum(float(np.trace(products)) for _, products, _ in meetings)
    freedom = sum(size * (len(members) - 1) for members, _, size in meetings)
    variance = np.where(counts > 0, total / freedom, 0.0)
    if total > 0:
        variance = _iterate(variance, meetings, counts)
    return tuple(Spread(sqrt(float(variance[i])) if counts[i] else None, int(counts[i])) for i in range(people))


def _iterate(variance: Array, meetings: Sequence[tuple[Array, Array, int]], counts: Array) -> Array:
    smallest = 1e-12 * variance.max()
    for _ in range(EM_STEPS):
        sums = np.zeros_like(variance)
        for members, products, size in meetings:
            weights = 1 / np.maximum(variance[members], smallest)
            projector = np.eye(len(members)) - weights / weights.sum()
            sums[members] += np.diag(projector @ products @ projector.T) + size / weights.sum()
        following = np.where(counts > 0, sums / np.maximum(counts, 1), 0.0)
        if np.abs(following - variance).max() <= EM_TOLERANCE * variance.max():
            return following
        variance = following
    return variance


def _find_biases(xy: Array, shared: Array) -> tuple[Bias, ...]:
    count = shared.sum(axis=0)
    total = (xy * shared[..., None]).sum(axis=0)
    biases = []
    for mine, is_mine in zip(xy, shared, strict=True):
        if not is_mine.any():
            biases.append(Bias(None, None))
            continue
        others = (total - mine)[is_mine] / (count[is_mine] - 1)[:, None]
        x, y = (mine[is_mine] - others).mean(axis=0)
        biases.append(Bias(float(x), float(y)))
    return tuple(biases)


def _compare_pairs(xy: Array, state: Array, placed: Array) -> tuple[PairAgreement, ...]:
    """OKS of a hand is the mean over its joints of exp(-d² / (2 s² k²)), k = 2 σ of the joint, s² the area of the box
    around the mean joints of all people; the pair's is the mean over hands."""
    areas = _find_areas(xy, placed)
    pairs = []
    for first in range(len(xy)):
        for second in range(first + 1, len(xy)):
            both = placed[first] & placed[second]
            squares = ((xy[first] - xy[second]) ** 2).sum(axis=-1)
            with np.errstate(divide="ignore", invalid="ignore"):
                similarity = np.exp(-squares / (2 * areas[:, None] * (2 * OKS_SIGMAS) ** 2))
            is_measured = both.any(axis=1) & (areas >= 1)
            hands = [similarity[place][both[place]].mean() for place in np.flatnonzero(is_measured)]
            seen = (state[first] >= 0) & (state[second] >= 0)
            differs = state[first][seen] != state[second][seen]
            pairs.append(
                PairAgreement(
                    first,
                    second,
                    int(both.sum()),
                    float(np.sqrt(squares[both]).mean()) if both.any() else None,
                    float(np.mean(hands)) if hands else None,
                    float(differs.mean()) if seen.any() else None,
                )
            )
    return tuple(pairs)


def _find_areas(xy: Array, placed: Array) -> Array:
    """(P,) px² of the box around each hand's mean joints."""
    count = placed.sum(axis=0)
    mean = (xy * placed[..., None]).sum(axis=0) / np.maximum(count, 1)[..., None]
    low = np.where(count[..., None] > 0, mean, np.inf).min(axis=1)
    high = np.where(count[..., None] > 0, mean, -np.inf).max(axis=1)
    sides = np.where(np.isfinite(low) & np.isfinite(high), high - low, 0.0)
    return sides.prod(axis=-1)


def _find_disagreement(state: Array) -> tuple[float | None, ...]:
    """(21,) share of pairs of people who see a joint's state (visible, occluded, absent) differently."""
    shares: list[float | None] = []
    for joint in range(21):
        seen = np.stack([(state[..., joint] == value).sum(axis=0) for value in (0, 1, 2)])  # (3, P)
        people = seen.sum(axis=0)
        pairs = (people * (people - 1) / 2).sum()
        alike = (seen * (seen - 1) / 2).sum()
        shares.append(float(1 - alike / pairs) if pairs else None)
    return tuple(shares)
