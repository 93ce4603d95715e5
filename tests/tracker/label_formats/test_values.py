"""Numbers of label files are finite, of the shape that was asked for, and of a sensible size, or the place is named."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import array_shapes, arrays

from tracker.capture.document import Node, parse_json
from tracker.errors import AnnotationError
from tracker.label_formats.formats import LABEL_FORMATS, recognise_labels
from tracker.label_formats.values import find_json, read_numbers, write_json

numbers = arrays(np.float64, array_shapes(min_dims=1, max_dims=3, max_side=4), elements=st.floats(-1e6, 1e6))


def node(value: object) -> Node:
    return parse_json(json.dumps(value).encode(), "labels.json", AnnotationError)


@given(numbers, st.booleans())
def test_numbers_come_back_from_nested_lists_and_from_one_flat_list(values, is_flat) -> None:
    written = values.ravel().tolist() if is_flat else values.tolist()
    assert np.array_equal(read_numbers(node(written), values.shape, 1e6), values)


@pytest.mark.parametrize(
    "value",
    [[1.0, 2.0], [1.0, 2.0, 3.0, 4.0], [1.0, 2.0, 11.0], [1.0, 2.0, "3"], [1.0, 2.0, None], [1.0, 2.0, True], 3.0, {}],
    ids=str,
)
def test_anything_else_is_refused_with_the_file_it_is_in(value) -> None:
    with pytest.raises(AnnotationError, match=r"labels\.json"):
        read_numbers(node(value), (3,), 10.0)


def test_a_list_that_is_too_deep_or_too_long_is_refused_before_it_is_walked() -> None:
    with pytest.raises(AnnotationError, match="shorter list"):
        read_numbers(node([[0.0]] * 1001), (1001, 1), 1.0)
    deep: list = [0.0]
    for _ in range(5):
        deep = [deep]
    with pytest.raises(AnnotationError):
        read_numbers(node(deep), (1,), 1.0)


def test_one_file_of_an_ending_is_found_in_any_folder_and_two_or_none_are_refused() -> None:
    files = {"a/train_xyz.json": b"[1]", "b/train_K.json": b"[2]"}
    assert find_json(files, "_xyz.json").value == [1]
    for missing in ("_joint_3d.json", ".json"):
        with pytest.raises(AnnotationError, match=r"Needed one file \.\.\..*; found [02] among"):
            find_json(files, missing)


@given(
    st.dictionaries(st.text(), st.one_of(st.integers(), st.floats(allow_nan=False, allow_infinity=False), st.text()))
)
def test_what_is_written_is_json_of_one_line_and_the_same_bytes_every_time(document) -> None:
    data = write_json(document)
    assert json.loads(data) == document and data == write_json(dict(document)) and data.count(b"\n") == 1


@pytest.mark.parametrize(
    ("files", "format"),
    [
        ({"x/InterHand2.6M_train_joint_3d.json": b""}, "interhand"),
        ({"training_xyz.json": b"", "training_K.json": b""}, "freihand"),
        ({"CollectedData_me.CSV": b""}, "deeplabcut"),
        ({"09/joints_2D_GT/000.txt": b"", "09/joints_2D_GT/001.txt": b""}, "t16"),
        ({"a.json": b'{"annotations": [{"lefthand_kpts": []}], "categories": []}'}, "coco_wholebody"),
        ({"a.json": b'{"annotations": [{"righthand_kpts": []}], "categories": []}'}, "coco_wholebody"),
        ({"a.json": b'{"annotations": [], "categories": []}'}, "coco_keypoints"),
        ({"a.json": b'{"items": [], "joints": []}'}, "annotations"),
    ],
)
def test_a_format_is_known_by_its_names_or_its_words(files, format) -> None:
    assert recognise_labels(files) == format and format in LABEL_FORMATS


@pytest.mark.parametrize(
    "files",
    [{}, {"a.json": b"{}"}, {"my_xyz.json.bak": b""}, {"a.json": b'{"items": [], "joints": []}', "b.json": b""}],
)
def test_what_could_be_several_or_none_is_refused_with_what_there_is(files) -> None:
    with pytest.raises(AnnotationError, match="say the format: "):
        recognise_labels(files)
