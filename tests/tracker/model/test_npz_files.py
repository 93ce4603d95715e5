"""Handloom's own model files."""

from __future__ import annotations

import io
import json
import zipfile
from dataclasses import fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tracker.errors import ModelFileError
from tracker.model import ArticulatedModel, Skeleton, load_model, save_model
from tracker.model.default_hand import DATA, default_hand
from tracker.model.mirroring import mirror

GIVEN = DATA.read_bytes()


def assert_same(one: object, other: object) -> None:
    """Equal to the last bit."""
    assert type(one) is type(other)
    if is_dataclass(one):
        for field in fields(one):
            assert_same(getattr(one, field.name), getattr(other, field.name))
    elif isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        assert one.dtype == other.dtype and one.shape == other.shape
        assert one.tobytes() == other.tobytes()
    elif isinstance(one, dict) and isinstance(other, dict):
        assert list(one) == list(other)
        for key in one:
            assert_same(one[key], other[key])
    elif isinstance(one, tuple) and isinstance(other, tuple):
        assert len(one) == len(other)
        for a, b in zip(one, other, strict=True):
            assert_same(a, b)
    else:
        assert one == other


def a_stick() -> ArticulatedModel:
    """A tetrahedron on one bone, no joints."""
    return ArticulatedModel(
        name="stick",
        vertices=np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 0.1,
        faces=np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]),
        skinning_weights=np.ones((4, 1)),
        skeleton=Skeleton(
            ("root",),
            np.array([-1]),
            np.eye(4)[None],
            np.zeros(0, dtype=np.int64),
            np.zeros((0, 3)),
            np.zeros(0),
            np.zeros(0),
        ),
    )


@pytest.mark.parametrize("side", ["right", "left"])
def test_a_hand_comes_back_to_the_last_bit(tmp_path: Path, side: str) -> None:
    save_model(default_hand(side), tmp_path / "hand.npz")
    assert_same(load_model(tmp_path / "hand.npz"), default_hand(side))


def test_an_object_without_joints_comes_back_to_the_last_bit(tmp_path: Path) -> None:
    save_model(a_stick(), tmp_path / "stick.npz")
    assert_same(load_model(tmp_path / "stick.npz"), a_stick())


def test_the_same_model_gives_the_same_bytes_and_leaves_no_other_file(tmp_path: Path) -> None:
    for name in ("a.npz", "b.npz"):
        save_model(default_hand("right"), tmp_path / name)
    assert (tmp_path / "a.npz").read_bytes() == (tmp_path / "b.npz").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.npz", "b.npz"]


def changed(tmp_path: Path, **arrays: np.ndarray | None) -> Path:
    """The default hand's file with some arrays replaced or left out."""
    with np.load(DATA) as given:
        kept = {name: given[name] for name in given.files}
    kept |= {name: array for name, array in arrays.items() if array is not None}
    path = tmp_path / "changed.npz"
    np.savez_compressed(path, **{name: array for name, array in kept.items() if arrays.get(name, 0) is not None})
    return path


HAND = default_hand("right")
WEIGHTS = HAND.skinning_weights
BAD_ARRAYS = {
    "missing vertices": {"vertices": None},
    "vertices of float32": {"vertices": HAND.vertices.astype(np.float32)},
    "a vertex that is not a number": {"vertices": np.where(np.arange(3) == 1, np.nan, HAND.vertices)},
    "a vertex a light year away": {"vertices": HAND.vertices * 1e9},
    "two coordinates a vertex": {"vertices": HAND.vertices[:, :2].copy()},
    "a face with a vertex too many": {"faces": HAND.faces + len(HAND.vertices)},
    "a face with a negative vertex": {"faces": HAND.faces - 1},
    "weights for other vertices": {"skinning_weights": WEIGHTS[:-1]},
    "weights that sum to two": {"skinning_weights": np.full_like(WEIGHTS, 0.1)},
    "weights on all bones": {"skinning_weights": np.full_like(WEIGHTS, 0.05)},
    "a child before its parent": {"parents": HAND.skeleton.parents[::-1].copy()},
    "two roots": {"parents": np.full(20, -1)},
    "rest poses that shear": {"Ts_model_bone": HAND.skeleton.Ts_model_bone * 1.1},
    "long axes": {"dof_axes": HAND.skeleton.dof_axes * 0.9},
    "limits the wrong way round": {"lower": HAND.skeleton.upper, "upper": HAND.skeleton.lower},
    "another format": {"format": np.array(["somebody-else", "1"])},
    "a later version": {"format": np.array(["handloom-model", "99"])},
    "a third hand": {"hand_side": np.array(["middle"])},
    "a joint that is bone and vertex": {"hand_joint_vertices": np.zeros(21, dtype=np.int64)},
    "sets that do not add up": {"hand_set_sizes": np.full(25, 3)},
    "provenance that is no JSON": {"provenance": np.array(["{"])},
    "provenance that is a list": {"provenance": np.array(["[1]"])},
    "a shape for other vertices": {"shape_vertices": np.zeros((10, 3, 3))},
    "shape bounds without the mean": {"shape_lower": np.full(10, 1.0)},
}


@pytest.mark.parametrize("what", BAD_ARRAYS)
def test_a_file_with_a_wrong_array_is_refused_with_what_was_found_and_what_is_needed(tmp_path: Path, what: str) -> None:
    with pytest.raises(ModelFileError) as caught:
        load_model(changed(tmp_path, **BAD_ARRAYS[what]))
    assert caught.value.found and caught.value.needed


def test_a_pickled_array_is_refused_and_never_run(tmp_path: Path) -> None:
    with pytest.raises(ModelFileError):
        load_model(changed(tmp_path, provenance=np.array([{"a": 1}], dtype=object)))


def test_a_header_that_claims_terabytes_is_refused(tmp_path: Path) -> None:
    header = io.BytesIO()
    np.lib.format.write_array_header_1_0(header, {"descr": "<f8", "fortran_order": False, "shape": (10**12, 3)})
    with zipfile.ZipFile(tmp_path / "huge.npz", "w") as archive:
        archive.writestr("vertices.npy", header.getvalue())
    with pytest.raises(ModelFileError, match="claims"):
        load_model(tmp_path / "huge.npz")


def test_a_zip_bomb_is_refused(tmp_path: Path) -> None:
    with (
        zipfile.ZipFile(tmp_path / "bomb.npz", "w", zipfile.ZIP_DEFLATED) as archive,
        archive.open("a.npy", "w") as file,
    ):
        for _ in range(300):
            file.write(bytes(2**20))
    with pytest.raises(ModelFileError, match="too large"):
        load_model(tmp_path / "bomb.npz")


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.integers(0, len(GIVEN) - 1))
def test_a_truncated_file_is_refused(tmp_path: Path, cut: int) -> None:
    (tmp_path / "cut.npz").write_bytes(GIVEN[:cut])
    with pytest.raises(ModelFileError):
        load_model(tmp_path / "cut.npz")


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(changes=st.lists(st.tuples(st.integers(0, len(GIVEN) - 1), st.integers(0, 255)), min_size=1, max_size=40))
def test_a_garbled_file_gives_the_model_or_a_model_file_error(tmp_path: Path, changes: list[tuple[int, int]]) -> None:
    data = bytearray(GIVEN)
    for place, value in changes:
        data[place] = value
    (tmp_path / "garbled.npz").write_bytes(bytes(data))
    try:
        model = load_model(tmp_path / "garbled.npz")
    except ModelFileError:
        return
    assert model.num_dofs == HAND.num_dofs


def test_the_committed_hand_says_where_it_comes_from() -> None:
    with np.load(DATA) as file:
        provenance = json.loads(str(file["provenance"][0]))
    assert provenance["licence"] == "CC0 1.0" and "MakeHuman" in provenance["source"]


def test_joints_marked_elsewhere_are_kept(tmp_path: Path):
    hand = default_hand("left")
    assert hand.hand is not None
    offsets = np.random.default_rng(3).normal(scale=0.01, size=(21, 3))
    marked = replace(hand, hand=replace(hand.hand, joint_offsets=offsets))
    save_model(marked, tmp_path / "hand.npz")
    assert_same(load_model(tmp_path / "hand.npz"), marked)
    assert_same(mirror(mirror(marked)).hand, marked.hand)
