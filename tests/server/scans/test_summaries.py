"""What other rooms know of scans goes with them, and each is described under the address of its geometry."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database
from server.scans.models import ScanRow
from server.scans.service import write_geometry_key
from server.scans.summaries import describe_scans
from tests.server.scans.test_service import add_scan


def test_what_rooms_know_is_merged_and_each_is_asked_once(database: Database) -> None:
    ids = [add_scan(database, name, created_by=LOCAL_ACCOUNT_ID if name == "b" else None) for name in "ab"]
    registration = {"id": uuid.uuid4(), "verdict": "good", "score": 0.1, "round": 1, "model_id": uuid.uuid4()}
    asked: list[list[uuid.UUID]] = []

    def find(_: Any, wanted: Sequence[uuid.UUID]) -> dict[uuid.UUID, dict[str, Any]]:
        asked.append(list(wanted))
        return {ids[1]: {"registration": registration}}

    with database.reading() as session:
        rows = [session.get_one(ScanRow, id_) for id_ in ids]
        told = describe_scans(session, rows, [find])
        assert describe_scans(session, [], [find]) == []
        assert [one.geometry_key for one in told] == [write_geometry_key(row.digest, row.revision) for row in rows]
    assert asked == [ids], "nobody is asked about nothing"
    assert [None if one.registration is None else one.registration.id for one in told] == [None, registration["id"]]
    assert told[0].created_by_name is None and told[1].created_by_name


@pytest.mark.parametrize(("size", "told"), [([0.2, 0.1, 0.05], [0.2, 0.1, 0.05]), (None, [0.3, 0.2, 0.1])])
def test_a_scan_that_was_never_measured_has_the_size_of_its_box_longest_first(database: Database, size, told) -> None:
    id_ = add_scan(database, extent_m=[0.1, 0.3, 0.2], size_m=size)
    with database.reading() as session:
        [found] = describe_scans(session, [session.get_one(ScanRow, id_)], [])
    assert (found.size_m, found.extent_m) == (told, [0.1, 0.3, 0.2])
