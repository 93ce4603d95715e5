"""Errors of a registration by vertex and by point, people left out in turn, and models that are kept at hand."""

from __future__ import annotations

import shutil
import uuid
from types import SimpleNamespace

import numpy as np
import pytest

from server.errors import NotFoundError
from server.hand_models.models import HandModelRow
from server.hand_models.storing import describe_model, write_model
from server.jobs.run import WorkerContext
from server.jobs.scan_run import ModelCache, measure_errors, study_people
from tracker import BlendModel, Registration, Scan, untrained_hand


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


def register(vertices: np.ndarray, distances: np.ndarray) -> Registration:
    return Registration(
        vertices=vertices,
        model_vertices=vertices,
        faces=np.zeros((0, 3), dtype=np.int64),
        pose=np.zeros((16, 3)),
        shape=np.zeros(0),
        translation=np.zeros(3),
        side="right",
        verdict="good",
        score=0.1,
        reasons=(),
        scan_to_mesh=distances,
        seconds=1.0,
    )


def as_scan(points: np.ndarray) -> Scan:
    return Scan(points, np.zeros_like(points), None, None, "points")


def test_a_vertex_has_the_mean_error_of_the_points_that_are_nearest_to_it(rng: np.random.Generator) -> None:
    vertices, points = rng.normal(size=(12, 3)), rng.normal(size=(60, 3))
    distances = rng.uniform(0.0, 0.01, 60)
    of_vertices, of_points = measure_errors(register(vertices, distances), as_scan(points), np.ones(60, bool))
    nearest = np.linalg.norm(points[:, None] - vertices, axis=2).argmin(axis=1)
    for vertex in range(12):
        own = 1e3 * distances[nearest == vertex]
        assert of_vertices[vertex] == pytest.approx(own.mean() if len(own) else np.nan, nan_ok=True)
    np.testing.assert_allclose(of_points, 1e3 * distances)


def test_points_that_were_left_out_have_no_error_and_those_that_are_of_no_hand_count_nowhere() -> None:
    vertices = np.array([[0.0, 0, 0], [1.0, 0, 0]])
    points = np.array([[0.1, 0, 0], [0.2, 0, 0], [0.9, 0, 0]])
    distances, kept = np.array([0.001, np.nan, 0.003]), np.array([True, False, True, False, True])
    of_vertices, of_points = measure_errors(register(vertices, distances), as_scan(points), kept)
    assert of_vertices == pytest.approx([1.0, 3.0])
    assert of_points == pytest.approx([1.0, np.nan, np.nan, np.nan, 3.0], nan_ok=True)


def test_where_no_point_is_of_a_hand_no_vertex_has_an_error() -> None:
    found = register(np.zeros((2, 3)), np.full(3, np.nan))
    of_vertices, of_points = measure_errors(found, as_scan(np.zeros((3, 3))), np.ones(3, bool))
    assert np.isnan(of_vertices).all() and np.isnan(of_points).all()


def people(names: list[str], templates: int | None = None) -> SimpleNamespace:
    count = len(names) if templates is None else templates
    made = np.random.default_rng(3).normal(size=(count, 30, 3))
    return SimpleNamespace(report={"by_hand": names}, templates=made)


def test_each_person_is_left_out_with_both_hands() -> None:
    """Two hands of one person count as one: of four people, two directions at most, and the mean alone."""
    names = ["Ada", "Ada (left)", "Bob", "Cy", "Di (left)"]
    found = study_people(people(names))["shape_generalisation"]  # type: ignore[arg-type]
    assert [one["components"] for one in found] == [0, 1, 2]
    errors = [one["mean_mm"] for one in found]
    assert errors == sorted(errors, reverse=True)


@pytest.mark.parametrize("names", [[], ["Ada"], ["Ada", "Bob"], ["Ada", "Ada (left)", "Bob"]])
def test_of_two_people_nothing_can_be_said_of_others(names: list[str]) -> None:
    assert study_people(people(names)) == {}  # type: ignore[arg-type]


def test_hands_without_a_shape_of_their_own_are_not_studied() -> None:
    assert study_people(people(["Ada", "Bob", "Cy", "Di"], templates=2)) == {}  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def hand() -> BlendModel:
    return untrained_hand("right")


@pytest.fixture
def models(context: WorkerContext, hand: BlendModel) -> list[uuid.UUID]:
    """Two stored models that are alike."""
    ids = [uuid.uuid4() for _ in range(2)]
    digest, facts = write_model(context.storage, ids[0], hand), describe_model(hand)
    shutil.copytree(context.storage.folder("models", ids[0]), context.storage.folder("models", ids[1]))
    with context.database.writing() as session:
        for id_, name in zip(ids, "ab", strict=True):
            session.add(HandModelRow(id=id_, name=name, kind="trained", side="right", digest=digest, facts=facts))
    return ids


def test_a_model_is_opened_once_and_the_one_used_longest_ago_makes_room(context: WorkerContext, models) -> None:
    ids, cache = models, ModelCache(context, most=1)
    row, model = cache.get(ids[0])
    assert (row.name, cache.get(ids[0])[1] is model) == ("a", True)
    cache.get(ids[1])
    assert cache.get(ids[0])[1] is not model
    with pytest.raises(NotFoundError, match="There is no hand model"):
        cache.get(uuid.uuid4())
