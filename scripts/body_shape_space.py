"""The shape space of body and hands together, and how the people of a sex are spread in it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from body_people import ANSUR, HandSize, hand_length
from body_surface import R_BODY_HAND, BodySurface

from tracker.model.blend_model import BlendModel

Array = npt.NDArray[np.float64]

NUM_BODY = 16
"""Directions of body and hands together, as many as SMPL-H files of the second edition have."""
NUM_HANDS = 4
"""Directions of the hands alone behind them."""
HAND_EMPHASIS = 4.0
"""How much more a millimetre of the hands counts than one of the body when directions are chosen."""


@dataclass(frozen=True)
class ShapeSpace:
    """Of one side and the midline, N vertices and J joints of the body.

    Attributes:
        mean: (N, 3) m.
        directions: (N, 3, S) m; coefficients of everybody, both sexes alike often, have mean 0 and variance 1.
        joints: (J, 3) m.
        joint_directions: (J, 3, S) m.
        population: For each sex mean (S,) and factor (S, S): coefficients are mean + factor @ standard normal ones.
    """

    mean: Array
    directions: Array
    joints: Array
    joint_directions: Array
    population: dict[str, tuple[Array, Array]]


def learn_shape_space(people: dict[str, tuple[Array, Array]], surface: BodySurface) -> ShapeSpace:
    """Principal directions of people (count, N, 3) with joints (count, J, 3) for each sex, m."""
    vertices = np.concatenate([rights for rights, _ in people.values()])
    joints = np.concatenate([placed for _, placed in people.values()])
    mean, joint_mean = vertices.mean(axis=0), joints.mean(axis=0)
    emphasis = np.ones(len(mean))
    emphasis[surface.right_hand] = HAND_EMPHASIS
    data = (vertices - mean).reshape(len(vertices), -1)
    U, S, _ = np.linalg.svd(data * np.repeat(emphasis, 3), full_matrices=False)
    scores = U[:, :NUM_BODY] * np.sqrt(len(vertices))
    directions = (data.T @ scores / len(vertices)).reshape(*mean.shape, NUM_BODY)
    joint_directions = np.einsum("njx,ns->jxs", joints - joint_mean, scores) / len(vertices)
    print(
        "share of the weighted variance in the directions:", round(float((S[:NUM_BODY] ** 2).sum() / (S**2).sum()), 4)
    )
    population = {}
    first = 0
    for sex, (rights, _) in people.items():
        own = scores[first : first + len(rights)]
        first += len(rights)
        population[sex] = own.mean(axis=0), _factor(np.cov(own.T))
    return ShapeSpace(mean, directions, joint_mean, joint_directions, population)


def fit_population(space: ShapeSpace, measure: Array, start: Array) -> ShapeSpace:
    """The space with people of whom two measurements are as in ANSUR II: stature and hand length.

    Args:
        space: Learnt.
        measure: (2, S) how the measurements follow the coefficients, m.
        start: (2,) what the mean shape measures, m.
    """
    population = {}
    for sex, (mean, factor) in space.population.items():
        told = ANSUR[sex]
        chosen = [0, 2]
        wanted = np.outer(told.deviation[chosen], told.deviation[chosen]) * told.correlation[np.ix_(chosen, chosen)]
        covariance = factor @ factor.T
        seen = measure @ covariance @ measure.T
        carried = covariance @ measure.T @ np.linalg.inv(seen)
        # along what the measurements say of the coefficients the spread is replaced, beside it it stays
        turned = carried @ (wanted - seen) @ carried.T
        moved = mean + carried @ (told.mean[chosen] - start - measure @ mean)
        population[sex] = moved, _factor(covariance + turned)
    return ShapeSpace(space.mean, space.directions, space.joints, space.joint_directions, population)


def add_hand_directions(space: ShapeSpace, surface: BodySurface, hand: BlendModel) -> ShapeSpace:
    """The space with directions of the hands alone, which change neither their length nor their breadth."""
    size = HandSize.measure(hand)
    scales = [np.diag([1.0, 0.0, 0.0]) @ hand.template.T, np.diag([0.0, 1.0, 1.0]) @ hand.template.T]
    known = np.stack([field.T.ravel() for field in scales], axis=1)
    free = hand.shape_directions.reshape(-1, hand.num_shape)
    free = free - known @ np.linalg.lstsq(known, free, rcond=None)[0]
    U, S, _ = np.linalg.svd(free, full_matrices=False)
    own = (U[:, :NUM_HANDS] * S[:NUM_HANDS]).reshape(*hand.template.shape, NUM_HANDS)
    lengths = np.array([HandSize.measure(_with_template(hand, own[..., k])).length for k in range(NUM_HANDS)])
    own -= np.einsum("vx,k->vxk", hand.template, lengths / size.length - 1.0)
    placed = np.einsum("xy,vyk->vxk", R_BODY_HAND, own)
    added = np.zeros((*space.mean.shape, NUM_HANDS))
    added[surface.right_hand] = placed
    added[surface.right_band] = np.einsum("nh,hxk->nxk", surface.band[:, surface.num_half :], placed)
    population = {}
    for sex, (mean, factor) in space.population.items():
        whole = np.eye(len(mean) + NUM_HANDS)
        whole[: len(mean), : len(mean)] = factor
        population[sex] = np.concatenate([mean, np.zeros(NUM_HANDS)]), whole
    return ShapeSpace(
        space.mean,
        np.concatenate([space.directions, added], axis=2),
        space.joints,
        np.concatenate([space.joint_directions, np.zeros((*space.joints.shape, NUM_HANDS))], axis=2),
        population,
    )


def _with_template(hand: BlendModel, offsets: Array) -> BlendModel:
    return replace(hand, template=hand.template + offsets)


def _factor(covariance: Array) -> Array:
    """(S, S) F with F F^T the covariance: its principal axes, the widest first."""
    values, vectors = np.linalg.eigh(covariance)
    order = np.argsort(-values)
    return vectors[:, order] * np.sqrt(np.maximum(values[order], 0.0))


def measure_people(space: ShapeSpace, surface: BodySurface) -> tuple[ShapeSpace, Array, Array]:
    """What `fit_population` needs: the space, (2, S) stature and hand length by the coefficients, (2,) of the mean."""
    crown, sole = (int(pick(space.mean[:, 1])) for pick in (np.argmax, np.argmin))

    def measured(shape: Array) -> Array:
        shaped = space.mean + space.directions @ shape
        own = shaped[surface.right_hand] @ R_BODY_HAND
        length = hand_length(surface.hand.joint_regressor @ own, own[surface.hand.tips[2]], surface.hand.joint_names)
        return np.array([shaped[crown, 1] - shaped[sole, 1], length])

    size = space.directions.shape[2]
    columns = [measured(unit) - measured(-unit) for unit in np.eye(size)]
    return space, 0.5 * np.stack(columns, axis=1), measured(np.zeros(size))
