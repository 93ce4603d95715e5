"""The text files of T16's models: read as they are written, and refused where a count or a number is not sound."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tracker.errors import ModelFileError
from tracker.model import t16_text
from tracker.model.t16_text import read_limits, read_motion, read_off, read_skel, read_skin, read_text, read_voi

SQUARE = "OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
SKEL = "bones\nnone\nwrist\n10\nwrist\nupper arm\n20\n"
LIMITS = "wrist\n1 0 1 0\n1 0 0\n0 1 0\n0 0 1\n-10 10\n0 0\n-5 90\n"
many = settings(max_examples=50, suppress_health_check=[HealthCheck.function_scoped_fixture])


@pytest.fixture
def write(tmp_path: Path):
    def write(text: str | bytes, name: str = "a.txt") -> Path:
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return path

    return write


@pytest.mark.parametrize(
    "text", [SQUARE, SQUARE.replace("OFF\n", "OFF "), SQUARE.replace("1 1 0", "# a corner\n\n  1 1 0 # this")]
)
def test_a_mesh_is_its_vertices_and_its_polygons_as_fans(text: str, write) -> None:
    vertices, faces = read_off(write(text))
    assert vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] and faces.tolist() == [
        [0, 1, 2],
        [0, 2, 3],
    ]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "the first line missing"),
        ("OBJ\n", "the first line 'OBJ'"),
        ("OFF\n", "counts"),
        ("OFF\n4 x 0", "whole numbers"),
        ("OFF\n2 1 0", "counts"),
        ("OFF\n99999999 1 0", "counts"),
        ("OFF\n4 9 0\n0 0 0", "as its head says"),
        (SQUARE.replace("4 0 1 2 3", "4 0 1 2"), "the face"),
        (SQUARE.replace("4 0 1 2 3", "2 0 1"), "the face"),
        (SQUARE.replace("4 0 1 2 3", "3 0 1 4"), "with vertex 4"),
        (SQUARE.replace("4 0 1 2 3", "3 0 1 -1"), "vertices 0 to 3"),
        (SQUARE.replace("4 0 1 2 3", f"3 0 1 {10**30}"), "damaged"),
        (SQUARE.replace("1 1 0", "1 nan 0"), "infinite"),
        (SQUARE.replace("1 1 0", "1 one 0"), "3 numbers"),
        (SQUARE.replace("1 1 0", "1 1"), "3 numbers|damaged"),
    ],
)
def test_a_mesh_that_is_not_what_its_head_says_is_refused(text: str, told: str, write) -> None:
    with pytest.raises(ModelFileError, match=told):
        read_off(write(text))


def test_bones_are_read_with_their_parents(write) -> None:
    names, parents, lengths = read_skel(write(SKEL))
    assert (names, parents.tolist(), lengths.tolist()) == (("wrist", "upper arm"), [-1, 0], [10, 20])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("bones\n", "0 lines"),
        (SKEL + "wrist\n", "7 lines"),
        (SKEL.replace("upper arm", "wrist"), "named twice"),
        ("bones\narm\nwrist\n1\nnone\narm\n2\n", "one tree in order"),
        (SKEL.replace("\nwrist\nupper", "\nother\nupper"), "one tree in order"),
        (SKEL.replace("20", "inf"), "infinite"),
        ("bones\n" + "".join(f"b{n - 1}\nb{n}\n1\n" for n in range(257)), "1 to 256 bones"),
    ],
)
def test_bones_that_are_no_tree_are_refused(text: str, told: str, write) -> None:
    with pytest.raises(ModelFileError, match=told):
        read_skel(write(text))


def test_weights_are_put_into_the_order_of_the_bones_and_sum_to_one(write) -> None:
    weights = read_skin(write("2\nupper arm wrist\n0.6 0.6\n1 0\n"), ("wrist", "upper arm"), 2)
    np.testing.assert_allclose(weights, [[0.5, 0.5], [0, 1]])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("2\nwrist upper arm\n1 0\n", "1 rows of weights"),
        ("3\nwrist upper arm\n1 0\n1 0\n", "'3' bones"),
        ("2\nwrist lower arm\n1 0\n1 0\n", "the names of the"),
        ("2\nwrist upper arm\n1 0\n-1 2\n", "negative"),
        ("2\nwrist upper arm\n1 0\n0 0\n", "far from summing"),
        ("2\nwrist upper arm\n1 0\nnan 1\n", "infinite"),
    ],
)
def test_weights_that_are_no_shares_are_refused(text: str, told: str, write) -> None:
    with pytest.raises(ModelFileError, match=told):
        read_skin(write(text), ("wrist", "upper arm"), 2)


def test_limits_are_eight_lines_a_bone(write) -> None:
    (bone,) = read_limits(write(LIMITS))
    assert bone.name == "wrist" and bone.flags.tolist() == [True, False, True, False]
    assert bone.ranges_deg.tolist() == [[-10, 10], [0, 0], [-5, 90]] and np.array_equal(bone.axes, np.eye(3))
    for text in ("", LIMITS + "more\n", LIMITS.replace("-5 90", "-5"), LIMITS.replace("0 1 0\n0 0", "0 1 inf\n0 0")):
        with pytest.raises(ModelFileError):
            read_limits(write(text))


def test_vertices_of_interest_are_three_rows_of_five(write) -> None:
    text = "\n".join(" ".join(str(5 * row + k) for k in range(5)) for row in range(3))
    assert read_voi(write(text), 15).tolist() == np.arange(15).reshape(3, 5).tolist()
    for bad, size in ((text, 14), (text + " 1", 99), ("", 99), (text.replace("3", "3.5"), 99), ("-1 " + text[2:], 99)):
        with pytest.raises(ModelFileError):
            read_voi(write(bad), size)


@many
@given(st.lists(st.floats(-4, 4), min_size=3, max_size=3), st.integers(1, 3), st.integers(1, 3))
def test_motions_of_several_bones_come_back(write, turn: list[float], frames: int, bones: int) -> None:
    R = Rotation.from_rotvec(turn).as_matrix()
    row = " ".join(f"{value:.9f}" for value in [*R.ravel(), 1.0, -2.0, 3.5])
    names, Ts = read_motion(write("".join(f"bone {b}\n" + f"{row}\n" * frames for b in range(bones))))
    assert names == tuple(f"bone {b}" for b in range(bones)) and Ts.shape == (frames, bones, 4, 4)
    np.testing.assert_allclose(Ts[..., :3, :3], np.broadcast_to(R, (frames, bones, 3, 3)), atol=1e-8)
    np.testing.assert_allclose(Ts[..., :3, :3] @ Ts[..., :3, :3].mT - np.eye(3), 0, atol=1e-14)
    assert (Ts[..., :3, 3] == [1.0, -2.0, 3.5]).all()


IDENTITY = "1 0 0 0 1 0 0 0 1 0 0 0\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "0 bones"),
        (IDENTITY, "before the first bone"),
        (f"a\n{IDENTITY}b\n", "same number of rows"),
        (f"a\n{IDENTITY}b\n{IDENTITY}{IDENTITY}", "same number of rows"),
        ("a\n1 0 0 0 1 0 0 0 1 0 0\n", "12 numbers|damaged"),
        (f"a\n{IDENTITY.replace('1', 'nan')}", "infinite"),
        (f"a\n{IDENTITY.replace('1', '2')}", "does not rotate"),
        ("a\n1 0 0 0 1 0 0 0 -1 0 0 0\n", "does not rotate"),
    ],
)
def test_motions_that_are_no_rigid_motions_are_refused(text: str, told: str, write) -> None:
    with pytest.raises(ModelFileError, match=told):
        read_motion(write(text))


def test_a_gzipped_text_is_read_and_one_that_swells_is_refused(write, monkeypatch: pytest.MonkeyPatch) -> None:
    assert read_text(write(gzip.compress(b" a \nb"), "a.txt.gz")) == ["a", "b"]
    for data in (b"no gzip", gzip.compress(b"a" * 99)[:-9]):
        with pytest.raises(ModelFileError, match="gzipped"):
            read_text(write(data, "a.txt.gz"))
    monkeypatch.setattr(t16_text, "MAX_BYTES", 999)
    with pytest.raises(ModelFileError, match="more than 999 bytes"):
        read_text(write(gzip.compress(b"a" * 1000), "a.txt.gz"))
