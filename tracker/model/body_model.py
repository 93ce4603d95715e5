"""A body with both hands on one mesh, made by `scripts/build_body.py`: the class of SMPL-H, [R17] §3.4."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from tracker.errors import ModelFileError, reads
from tracker.model.blend_files import blend_arrays, read_blend_fields
from tracker.model.blend_model import Array, BlendModel
from tracker.model.npz_arrays import NpzFields, read_npz_arrays
from tracker.model.npz_files import MAX_COORDINATE, write_npz_arrays

SEXES = ("male", "female")
POPULATIONS = ("neutral", *SEXES)
"""Whose statistics a model's shape coefficients can have; "neutral": both sexes alike often."""


@dataclass(frozen=True, eq=False)
class Population:
    """How the people of a sex are spread in the shape space: coefficients are mean + factor @ standard normal ones.

    Attributes:
        mean: (S,).
        factor: (S, S).
    """

    mean: Array
    factor: Array

    def draw(self, rng: np.random.Generator, count: int) -> Array:
        """(count, S) shape coefficients, one row for each person."""
        return self.mean + rng.standard_normal((count, len(self.mean))) @ self.factor.T


@dataclass(frozen=True, eq=False)
class BodyModel:
    """The body as its file holds it.

    Attributes:
        blend: The model of 52 joints in SMPL-H's order; everybody's mean and directions.
        populations: A Population for each of SEXES.
    """

    blend: BlendModel
    populations: dict[str, Population]

    def of(self, population: str) -> BlendModel:
        """The model whose mean shape is that population's and whose coefficients are its deviations.

        Args:
            population: One of POPULATIONS. Standard normal coefficients are then people as likely as they are; the
                first ones move the surface most.
        """
        assert population in POPULATIONS, f"population is {population!r}, not one of {POPULATIONS}"
        people = self.everybody if population == "neutral" else self.populations[population]
        directions = self.blend.shape_directions @ people.factor
        flat = directions.reshape(-1, directions.shape[2])
        turn = np.linalg.eigh(flat.T @ flat)[1][:, ::-1]
        turn = turn * np.where(flat[1::3].sum(axis=0) @ turn < 0.0, -1.0, 1.0)
        return replace(
            self.blend,
            name=f"{population} body with hands",
            template=self.blend.shaped(people.mean),
            shape_directions=np.ascontiguousarray(directions @ turn),
            provenance={**self.blend.provenance, "population": population},
        )

    @property
    def everybody(self) -> Population:
        """Men and women alike often, as one Gaussian of the same mean and covariance."""
        means = np.array([people.mean for people in self.populations.values()])
        within = np.mean([people.factor @ people.factor.T for people in self.populations.values()], axis=0)
        mean = means.mean(axis=0)
        values, vectors = np.linalg.eigh(within + (means - mean).T @ (means - mean) / len(means))
        return Population(mean, vectors * np.sqrt(np.maximum(values, 0.0)))


def save_body_model(body: BodyModel, path: Path) -> None:
    """Write a body; the file appears whole or not at all. Equal bodies give equal bytes."""
    arrays = blend_arrays(body.blend)
    for sex, people in body.populations.items():
        arrays |= {f"{sex}_mean": people.mean, f"{sex}_factor": people.factor}
    write_npz_arrays(Path(path), arrays)


@reads(ModelFileError, "a body with hands as Handloom writes it")
def load_body_model(path: Path) -> BodyModel:
    """Read a body that `save_body_model` wrote, checking every array of it.

    Raises:
        ModelFileError: With what was found and what is needed.
    """
    path = Path(path)
    fields = NpzFields(path, read_npz_arrays(path))
    blend = read_blend_fields(fields)
    if blend.side != "body":
        raise ModelFileError(path, f"a {blend.side} hand", "a body with both hands")
    size = blend.num_shape
    populations = {
        sex: Population(
            fields.floats(f"{sex}_mean", (size,), MAX_COORDINATE),
            fields.floats(f"{sex}_factor", (size, size), MAX_COORDINATE),
        )
        for sex in SEXES
    }
    return BodyModel(blend, populations)


@cache
def default_body() -> BodyModel:
    """The body that comes with Handloom. CC0, as all that it is made from. y up, arms along x, the face towards z."""
    return load_body_model(Path(__file__).parent / "data" / "body.npz")


@cache
def body_model(population: str = "neutral") -> BlendModel:
    """The body that comes with Handloom, for one of POPULATIONS: the same class that hands are, posed the same way."""
    return default_body().of(population)
