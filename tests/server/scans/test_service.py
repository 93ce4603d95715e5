"""Scans as rows: listed by what one asks, cropped, given another unit, each change a revision of its own."""

from __future__ import annotations

import uuid
from typing import Any

import numpy as np
import pytest

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Database
from server.errors import InvalidError, NotFoundError
from server.scans import service
from server.scans.models import ScanRow
from server.scans.schemas import PlaneStroke, ScanCrop
from server.scans.service import Kept, ScanFilter, StaleScanError
from tests.server.curation import make_ball


def add_scan(database: Database, name: str = "hand", **columns: Any) -> uuid.UUID:
    shared = {"collection": "hands", "subject": "Ada", "pose": "flat", "file": "scan.ply", "byte_count": 1}
    counts = {"point_count": 2000, "face_count": 0, "has_colors": False, "extent_m": [0.16] * 3, "notes": []}
    unit = {"metres_per_unit": 1.0, "first_metres_per_unit": 1.0}
    with database.writing() as session:
        row = ScanRow(name=name, digest=uuid.uuid4().hex * 2, **(shared | counts | unit | columns))
        session.add(row)
        session.flush()
        return row.id


def cut(offset: float) -> ScanCrop:
    return ScanCrop(strokes=[PlaneStroke(kind="plane", normal=(0.0, 0.0, 1.0), offset=offset)], drops_objects=False)


def test_a_crop_tells_how_many_points_go_and_how_large_the_rest_is() -> None:
    ball = make_ball(count=4000)
    kept = service.judge_crop(ball, cut(0.0))
    assert kept.removed == int((ball.points[:, 2] > 0).sum())
    assert max(kept.size_m) == pytest.approx(0.16, rel=0.05) and min(kept.size_m) == pytest.approx(0.08, rel=0.05)


def test_a_crop_that_leaves_too_little_is_refused_with_what_is_needed() -> None:
    with pytest.raises(InvalidError, match=r"leaves \d+ of 4000 points; needed at least 500"):
        service.judge_crop(make_ball(count=4000), cut(-0.079))


@pytest.mark.parametrize("factor", [0.75, 2.0])
def test_in_another_unit_a_scan_is_as_many_times_as_large_and_cropped_alike(database: Database, factor: float) -> None:
    id_, ball = add_scan(database), make_ball(count=4000)
    with database.writing() as session:
        before = service.judge_crop(ball, cut(0.02))
        row = service.put_crop(session, service.get_scan(session, id_), cut(0.02), before, 1, LOCAL_ACCOUNT_ID)
        crop = service.get_crop(session, id_, row.revision)
        scaled = service.scale_scan(ball, row, crop, factor)
        after = service.judge_crop(ball.scaled(factor), scaled.crop)
        assert after.removed == before.removed and np.allclose(after.size_m, factor * np.array(before.size_m))
        row = service.put_unit(session, row, scaled, 2, LOCAL_ACCOUNT_ID)
        assert (row.revision, row.metres_per_unit, row.state) == (3, factor, "new")
        assert np.allclose(row.extent_m, factor * 0.16) and np.allclose(row.size_m or [], scaled.size_m)
        assert [crop.revision for crop in service.list_crops(session, id_)] == [3, 2]


def test_a_unit_that_makes_no_hand_of_it_changes_nothing(database: Database) -> None:
    id_ = add_scan(database)
    with database.reading() as session, pytest.raises(InvalidError, match="Nothing was changed"):
        service.scale_scan(make_ball(), service.get_scan(session, id_), None, 1000.0)


def test_who_crops_an_older_revision_is_told_and_stores_nothing(database: Database) -> None:
    id_, kept = add_scan(database), Kept(0, [0.1, 0.1, 0.1])
    with database.writing() as session:
        service.put_crop(session, service.get_scan(session, id_), cut(0.05), kept, 1, LOCAL_ACCOUNT_ID)
    with database.writing() as session, pytest.raises(StaleScanError):
        service.put_crop(session, service.get_scan(session, id_), cut(0.01), kept, 1, LOCAL_ACCOUNT_ID)
    with database.reading() as session:
        assert len(service.list_crops(session, id_)) == 1
        assert service.read_crop(service.get_crop(session, id_, 2)) == cut(0.05)
        assert service.read_crop(service.get_crop(session, id_, 1)).strokes == []


def test_the_address_of_a_geometry_names_file_and_revision(database: Database) -> None:
    id_ = add_scan(database)
    with database.reading() as session:
        row = service.get_scan(session, id_)
        key = service.write_geometry_key(row.digest, 1)
        assert service.find_geometry_revision(row, key) == 1
        for wrong in (service.write_geometry_key(row.digest, 2), service.write_geometry_key("f" * 64, 1), "x", ""):
            with pytest.raises(NotFoundError, match="no geometry"):
                service.find_geometry_revision(row, wrong)


def test_scans_are_found_by_what_one_asks(database: Database) -> None:
    fist = add_scan(database, "left fist", pose="fist", subject="Bob")
    flat = add_scan(database, "right flat", collection="lab")
    with database.writing() as session:
        service.delete_scan(session, service.get_scan(session, add_scan_of(session)))

    def find(**asked: str) -> set[uuid.UUID]:
        with database.reading() as session:
            return {row.id for row in service.list_scans(session, ScanFilter(**asked), None, 10)[0]}

    assert find() == {fist, flat}
    assert find(pose="fist") == find(subject="Bob") == find(search="FIST left") == {fist}
    assert find(collection="lab") == find(search="flat") == {flat} and find(pose="fist", collection="lab") == set()


def add_scan_of(session: Any) -> uuid.UUID:
    """One more row, within a transaction."""
    row = ScanRow(
        **{"name": "gone", "digest": "0" * 64, "collection": "hands", "subject": "Ada", "pose": "fist"},
        **{"file": "scan.ply", "byte_count": 1, "point_count": 1, "face_count": 0, "has_colors": False},
        **{"extent_m": [0.1] * 3, "notes": []},
    )
    session.add(row)
    session.flush()
    return row.id


def test_a_deleted_scan_is_gone_until_it_is_restored(database: Database) -> None:
    id_ = add_scan(database)
    with database.writing() as session:
        service.delete_scan(session, service.get_scan(session, id_))
        with pytest.raises(NotFoundError, match="was deleted; it can be restored"):
            service.get_scan(session, id_)
        service.restore_scan(session, service.get_scan(session, id_, deleted_too=True))
        assert service.get_scan(session, id_).id == id_
