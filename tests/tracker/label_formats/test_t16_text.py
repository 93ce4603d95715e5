"""[T16]'s layout of labels: what a number means must be said, and nothing is guessed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.tracker.label_formats.conftest import FRAMES, MakeSet, make_sequence
from tracker.capture.annotations import Annotation
from tracker.errors import AnnotationError
from tracker.label_formats.image_names import list_image_names
from tracker.label_formats.label_set import ImportedLabels, ImportHints, LabelSet
from tracker.label_formats.orders import JOINT_ORDERS
from tracker.label_formats.t16_text import read_t16, write_t16

NAMES = "0 right/wrist\n1 left/thumb_tip\n"


def read(text: str | bytes, names: str | None = NAMES, where: str = "1", frame: str = "001", **hints) -> ImportedLabels:
    sequence = make_sequence()
    files = {f"{where}/joints_2D_GT/{frame}.txt": text if isinstance(text, bytes) else text.encode()}
    if names is not None:
        files[f"{where}/joints.txt"] = names.encode()
    return read_t16(files, [LabelSet("key", sequence, list_image_names(sequence))], ImportHints(**hints))


def test_lines_mark_the_joints_that_their_numbers_are_named_as() -> None:
    left, right = sorted(read("0 10 20\n1 30 40\n").annotations["key"].items, key=lambda item: item.hand)
    assert (right.frame, right.camera, right.points[0].tolist()) == (1, "cam0", [10, 20, 2])
    assert left.points[4].tolist() == [30, 40, 2] and np.count_nonzero(left.points) == 3


@pytest.mark.parametrize("place", ["0 20", "20 0", "-3 20", "-1 -1"])
def test_x_or_y_of_zero_or_less_is_a_joint_that_is_not_there(place: str) -> None:
    assert read(f"0 {place}\n").annotations["key"].items == ()


@pytest.mark.parametrize("order", JOINT_ORDERS)
def test_an_order_that_is_told_stands_in_for_names(order: str) -> None:
    text = "".join(f"{n} {n + 1} 5\n" for n in range(len(JOINT_ORDERS[order])))
    (item,) = read(text, None, joint_order=order, hand="left").annotations["key"].items
    assert item.hand == "left" and np.count_nonzero(item.points[:, 2]) == len(JOINT_ORDERS[order])


def test_the_camera_is_the_folders_number_or_the_one_that_is_told() -> None:
    assert read("0 1 2", where="a/2").annotations["key"].items[0].camera == "cam1"
    assert read("0 1 2", where="a/b", camera="cam1").annotations["key"].items[0].camera == "cam1"
    for where, hints, told in (
        ("a/3", {}, "unknown"),
        ("left", {}, "unknown"),
        ("1", {"camera": "x"}, "no camera 'x'"),
    ):
        with pytest.raises(AnnotationError, match=told):
            read("0 1 2", where=where, **hints)


def test_a_frame_that_the_recording_does_not_have_is_a_problem() -> None:
    assert "does not have" in read("0 1 2", frame=f"{FRAMES:03d}").problems[0]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("0 1", "needed a joint's number"),
        ("0 1 2 3", "needed a joint's number"),
        ("0 1.5 2", "needed a joint's number"),
        ("0 99999999 2", "needed a joint's number"),
        ("0 2000000 2", "is at"),
        ("2 1 2", "not among the 2"),
        ("0 1 2\n0 3 4", "appears twice"),
        ("0 1 2\n" * 1001, "1001 lines"),
        (b"\xff\xfe\x00", "damaged"),
    ],
)
def test_lines_that_are_no_joint_are_refused(text: str | bytes, told: str) -> None:
    with pytest.raises(AnnotationError, match=told):
        read(text)


@pytest.mark.parametrize(
    ("names", "told"),
    [
        (None, "does not name them"),
        ("0 right/nose", "needed lines such as"),
        ("0 both/wrist", "needed lines such as"),
        ("x right/wrist", "needed lines such as"),
        ("0 right/wrist\n0 left/wrist", "each number once"),
        ("0 right/wrist\n1 right/wrist", "names a joint twice"),
    ],
)
def test_names_that_leave_a_doubt_are_refused(names: str | None, told: str) -> None:
    with pytest.raises(AnnotationError, match=told):
        read("0 1 2", names)


def test_an_order_that_is_not_known_is_refused() -> None:
    with pytest.raises(AnnotationError, match="no joint order 'mine'"):
        read("0 1 2", joint_order="mine")


@given(st.text(st.characters(codec="utf-8"), max_size=20))
def test_any_text_is_read_or_refused(text: str) -> None:
    try:
        items = read(text).annotations["key"].items
    except AnnotationError:
        return
    assert all((item.points[item.points[:, 2] > 0, :2] > 0).all() for item in items)


def test_what_whole_pixels_lose_is_said(make_set: MakeSet) -> None:
    points = np.zeros((21, 3))
    points[0], points[1], points[2] = [10.4, 20, 2], [0.3, 5, 2], [7, 8, 1]
    written = write_t16([make_set((Annotation(2, "cam1", "right", points),))])
    assert sorted(written.files) == ["2/joints.txt", "2/joints_2D_GT/002.txt"] and written.joints == 2
    assert written.files["2/joints_2D_GT/002.txt"].decode().splitlines()[:3] == ["0\t10\t20", "1\t0\t0", "2\t7\t8"]
    assert any("rounded" in note for note in written.notes) and any("left out" in note for note in written.notes)
