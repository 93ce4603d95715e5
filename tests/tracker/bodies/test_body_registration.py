"""A body comes back from the disk as it was, and no file from outside gets past the door in another shape."""

from __future__ import annotations

import io
import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.bodies.posed_bodies import MODEL, draw_state, registration_of, stand
from tracker.bodies.body_registration import (
    BODY_FILE,
    MAX_COORDINATE,
    load_body_registration,
    pack_body_registration,
    save_body_registration,
)
from tracker.capture.scan import read_scan
from tracker.errors import RegistrationError


def changed(**arrays) -> bytes:
    """The file of a body with other arrays in it; those that are None are left out."""
    with np.load(io.BytesIO(pack_body_registration(registration_of(stand())))) as packed:
        whole = dict(packed) | arrays
    buffer = io.BytesIO()
    np.savez(buffer, **{name: array for name, array in whole.items() if array is not None})
    return buffer.getvalue()


@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32 - 1), st.text(max_size=40), st.tuples(st.booleans(), st.booleans()))
def test_every_number_and_word_comes_back(tmp_path_factory, seed: int, name: str, shown: tuple[bool, bool]) -> None:
    folder = tmp_path_factory.mktemp("body")
    state = draw_state(seed)
    one = registration_of(state, "doubtful", shown=shown, scan=name, measures={"chain": 3.0}, seconds={"body": 0.25})
    save_body_registration(one, MODEL.faces, folder)
    read = load_body_registration(folder)
    assert np.array_equal(read.vertices, one.vertices) and np.array_equal(read.model_vertices, one.model_vertices)
    for part in ("pose", "shape", "translation", "hands"):
        assert np.array_equal(getattr(read.state, part), getattr(state, part)), part
    assert (read.scan, read.are_shown, read.measures, read.seconds) == (name, shown, {"chain": 3.0}, {"body": 0.25})
    assert read.summary() == one.summary() and read.summary()["hands_shown"] == dict(
        zip(("left", "right"), shown, strict=True)
    )


def test_the_surface_beside_it_is_the_same_for_any_other_program(tmp_path) -> None:
    save_body_registration(registration_of(stand()), MODEL.faces, tmp_path)
    scan = read_scan(tmp_path / "body.ply")
    assert len(scan.points) == len(MODEL.template) and scan.faces is not None and len(scan.faces) == len(MODEL.faces)
    assert np.allclose(np.sort(scan.points[:, 1]), np.sort(stand().posed(MODEL).vertices[:, 1]), atol=1e-6)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"vertices": None}, "vertices"),
        ({"vertices": np.zeros((5, 2))}, "vertices"),
        ({"vertices": np.zeros((200_000, 3))}, "at most"),
        ({"model_vertices": np.zeros((7, 3))}, "model_vertices"),
        ({"poses": np.zeros((2, 156))}, "poses"),
        ({"poses": np.full((1, 156), np.nan)}, "poses"),
        ({"trans": np.full((1, 3), 2 * MAX_COORDINATE)}, "trans"),
        ({"hands": np.zeros((3, 6))}, "hands"),
        ({"betas": np.array(["a", "b"])}, "betas"),
        ({"are_shown": np.array([True])}, "are_shown"),
        ({"said": np.array("no JSON")}, "body.npz"),
        ({"said": np.array(json.dumps({"verdict": "good"}))}, "body.npz"),
        ({"said": np.array(json.dumps([1, 2]))}, "body.npz"),
    ],
)
def test_a_file_that_is_not_as_it_was_written_is_refused_by_the_name_of_what_is_wrong(tmp_path, wrong, said) -> None:
    (tmp_path / BODY_FILE).write_bytes(changed(**wrong))
    with pytest.raises(RegistrationError, match=said):
        load_body_registration(tmp_path)


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10**6), st.binary(min_size=1, max_size=8))
def test_a_file_with_other_bytes_somewhere_is_read_whole_or_refused(tmp_path_factory, place: int, other: bytes) -> None:
    data = bytearray(PACKED)
    place %= len(data) - len(other)
    data[place : place + len(other)] = other
    path = tmp_path_factory.mktemp("body") / BODY_FILE
    path.write_bytes(data)
    try:
        read = load_body_registration(path)
    except RegistrationError:
        return
    assert read.vertices.shape == (len(MODEL.template), 3) and np.isfinite(read.vertices).all()


PACKED = pack_body_registration(registration_of(stand()))
