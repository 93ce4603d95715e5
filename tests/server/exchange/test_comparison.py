"""What is different between two states of the labels is told joint by joint."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from server.exchange.comparison import compare_hands, compare_labels
from tracker import HAND_JOINTS, Annotation, Annotations


def make(frame: int = 0, camera: str = "cam0", hand: str = "right", **changes: tuple[float, float, int]) -> Annotation:
    """A hand whose joints lie in a row, all visible, but for those named."""
    points = np.array([[10.0 * number, 5.0, 2.0] for number in range(21)])
    for joint, point in changes.items():
        points[HAND_JOINTS.index(joint)] = point
    return Annotation(frame, camera, hand, points)


def test_the_same_hand_is_no_change() -> None:
    assert compare_hands(make(), make()) is None
    assert compare_labels(Annotations((make(),)), Annotations((make(),))) == []


def test_a_joint_that_moved_is_named_with_its_distance() -> None:
    moved = compare_hands(make(), make(wrist=(3.0, 9.0, 2), thumb_tip=(HAND_JOINTS.index("thumb_tip") * 10.0, 6.0, 2)))
    assert moved is not None and moved.kind == "changed"
    assert moved.joints_moved == {"wrist": 5.0, "thumb_tip": 1.0} and moved.max_shift_px == 5.0
    assert moved.joints_added == moved.joints_removed == moved.joints_restated == []


def test_joints_come_and_go_and_change_their_state() -> None:
    before = make(wrist=(0.0, 0.0, 0), thumb_mcp=(20.0, 5.0, 1))
    after = make(index_tip=(0.0, 0.0, 0), thumb_mcp=(20.0, 5.0, 2))
    found = compare_hands(before, after)
    assert found is not None
    assert (found.joints_added, found.joints_removed) == (["wrist"], ["index_tip"])
    assert found.joints_restated == ["thumb_mcp"] and found.joints_moved == {} and found.max_shift_px == 0.0


def test_a_joint_that_is_now_said_to_be_outside_changed_its_state() -> None:
    found = compare_hands(make(wrist=(0.0, 0.0, 0)), make(wrist=(-5.0, 3.0, 0)))
    assert found is not None and found.joints_restated == ["wrist"]


@pytest.mark.parametrize(("before", "after", "kind"), [((), (0,), "added"), ((0,), (), "removed")])
def test_a_whole_hand_is_added_or_removed_with_all_its_joints(before, after, kind) -> None:
    old, new = (Annotations(tuple(make(frame) for frame in frames)) for frames in (before, after))
    [change] = compare_labels(old, new)
    assert change.kind == kind
    assert (change.joints_added if kind == "added" else change.joints_removed) == list(HAND_JOINTS)


def test_changes_come_in_the_order_of_frames_cameras_and_hands() -> None:
    places = [(2, "cam0", "right"), (0, "cam1", "left"), (0, "cam0", "right"), (0, "cam0", "left")]
    found = compare_labels(Annotations(), Annotations(tuple(make(*place) for place in places)))
    assert [(change.frame, change.camera, change.hand) for change in found] == sorted(places)


@given(st.integers(0, 2**32 - 1))
def test_what_is_added_one_way_is_removed_the_other_and_shifts_are_the_same(seed: int) -> None:
    rng = np.random.default_rng(seed)

    def draw() -> Annotation:
        visibility = rng.integers(0, 3, (21, 1))
        return Annotation(0, "cam0", "right", np.hstack([rng.integers(1, 9, (21, 2)) * (visibility > 0), visibility]))

    there, back = compare_hands(old := draw(), new := draw()), compare_hands(new, old)
    assert there is not None and back is not None
    assert (there.joints_added, there.joints_removed) == (back.joints_removed, back.joints_added)
    assert there.joints_moved == back.joints_moved and there.max_shift_px == back.max_shift_px
    touched = {*there.joints_added, *there.joints_removed, *there.joints_restated, *there.joints_moved}
    assert touched == {name for name, a, b in zip(HAND_JOINTS, old.points, new.points, strict=True) if (a != b).any()}
