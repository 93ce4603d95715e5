"""A proposal is of the cameras that it was made from, and, once taken, of those that it gave."""

from __future__ import annotations

import copy

import pytest

from server.refinements.models import RefinementRow
from server.refinements.service import is_current

BEFORE = [{"id": "cam0", "color": "a", "K": [[500.0]], "distortion": [], "T_world_camera": [[1.0]]}]
AFTER = [BEFORE[0] | {"K": [[501.0]]}]
ELSE = [BEFORE[0] | {"K": [[502.0]]}]


@pytest.mark.parametrize(("state", "of"), [("proposed", BEFORE), ("put_back", BEFORE), ("taken", AFTER)])
def test_it_is_current_while_the_recording_has_the_cameras_that_it_is_of(state: str, of: list) -> None:
    row = RefinementRow(state=state, cameras_before=BEFORE, cameras_after=AFTER)
    assert [is_current(row, cameras) for cameras in (BEFORE, AFTER, ELSE)] == [of is BEFORE, of is AFTER, False]


def test_other_files_of_the_same_camera_change_nothing() -> None:
    renamed = copy.deepcopy(BEFORE)
    renamed[0]["color"] = "b"
    assert is_current(RefinementRow(state="proposed", cameras_before=BEFORE, cameras_after=AFTER), renamed)
