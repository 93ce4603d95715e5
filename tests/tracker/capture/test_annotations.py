"""The annotation file: order of joints, values, refusals."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tracker.capture import Annotation, Annotations, load_annotations, save_annotations
from tracker.capture.annotations import JOINT_NAMES
from tracker.errors import AnnotationError
from tracker.model.joints import HAND_JOINTS


def draw_points(seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([rng.uniform(0, 640, (21, 2)), rng.integers(0, 3, 21)])


def write(path: Path, **changes: Any) -> Path:
    points = [[float(x), float(y), int(v)] for x, y, v in draw_points()]
    item = {"frame": 0, "camera": "cam0", "hand": "right", "points": points}
    item |= {key: value for key, value in changes.items() if key in item}
    document = {"version": 1, "joints": list(HAND_JOINTS), "items": [item]}
    document |= {key: value for key, value in changes.items() if key in document}
    path.write_text(json.dumps(document))
    return path


def test_the_file_names_the_joints_as_the_models_do() -> None:
    assert JOINT_NAMES == HAND_JOINTS


def test_what_was_saved_is_read_back_to_the_last_bit(tmp_path: Path) -> None:
    items = [Annotation(f, "cam0", hand, draw_points(f)) for f in (7, 0) for hand in ("right", "left")]
    save_annotations(tmp_path / "annotations.json", items)
    loaded = load_annotations(tmp_path / "annotations.json")
    assert [item.key for item in loaded.items] == sorted(item.key for item in items)
    for item in items:
        found = loaded.find(*item.key)
        assert found is not None
        np.testing.assert_array_equal(found.points, item.points)
    assert len(loaded.at(7)) == 2 and loaded.at(1) == ()
    assert [p.name for p in tmp_path.iterdir()] == ["annotations.json"]


def test_joints_in_another_order_are_put_in_ours(tmp_path: Path) -> None:
    points = draw_points()
    order = np.random.default_rng(1).permutation(21)
    path = write(
        tmp_path / "a.json", joints=[HAND_JOINTS[i] for i in order], points=[points[i].tolist() for i in order]
    )
    np.testing.assert_array_equal(load_annotations(path).items[0].points, points)


@pytest.mark.parametrize(
    "changes",
    [
        {"version": 3},
        {"joints": list(HAND_JOINTS[:-1])},
        {"joints": [*HAND_JOINTS[:-1], "tail"]},
        {"joints": [*HAND_JOINTS[:-1], "wrist"]},
        {"joints": [*HAND_JOINTS, "wrist"]},
        {"joints": None},
        {"items": {}},
        {"items": [3]},
        {"frame": -1},
        {"frame": 1.0},
        {"camera": 5},
        {"hand": "both"},
        {"points": [[1, 2, 2]] * 20},
        {"points": [[1, 2, 2]] * 22},
        {"points": [[1, 2]] * 21},
        {"points": [[1, 2, 3]] * 21},
        {"points": [[1, 2, 0.5]] * 21},
        {"points": [[1, 2, True]] * 21},
        {"points": [[float("nan"), 2, 2]] * 21},
        {"points": [[1e9, 2, 2]] * 21},
        {"points": "none"},
    ],
    ids=str,
)
def test_refuses_an_impossible_value(tmp_path: Path, changes: dict[str, Any]) -> None:
    with pytest.raises(AnnotationError, match=r"a\.json"):
        load_annotations(write(tmp_path / "a.json", **changes))


def test_refuses_two_items_for_one_hand_in_one_image(tmp_path: Path) -> None:
    item = Annotation(0, "cam0", "right", draw_points())
    with pytest.raises(AnnotationError, match="two items"):
        save_annotations(tmp_path / "a.json", Annotations((item, item)))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("value", [np.nan, 1.5, 7.0])
def test_refuses_to_save_an_impossible_state_of_a_joint(tmp_path: Path, value: float) -> None:
    points = draw_points()
    points[3, 2] = value
    with pytest.raises(AnnotationError, match=r"points\[3\]"):
        save_annotations(tmp_path / "a.json", [Annotation(0, "cam0", "right", points)])
    assert list(tmp_path.iterdir()) == []
