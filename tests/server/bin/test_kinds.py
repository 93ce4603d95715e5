"""The table of what goes into the bin holds all that the program deletes, and each kind comes back."""

from __future__ import annotations

import pytest

from server.access.models import LOCAL_ACCOUNT_ID, Account, AuditRow
from server.bin.kinds import BIN_KINDS, BinKind
from server.bin.service import find_kind, is_deleted
from server.database import Base, Database, utc_now
from server.errors import NotFoundError
from server.hand_models.models import HandModelRow


def test_each_kind_has_a_name_of_its_own_and_a_parent_that_is_one_too() -> None:
    names = [kind.kind for kind in BIN_KINDS]
    assert len(set(names)) == len(names)
    assert {kind.parent[0] for kind in BIN_KINDS if kind.parent is not None} <= set(names)


def test_what_the_api_hides_by_a_time_can_be_brought_back_from_the_bin() -> None:
    hidden = {name for name, table in Base.metadata.tables.items() if "deleted_at" in table.c}
    restored = {kind.row.__tablename__ for kind in BIN_KINDS}
    assert hidden - restored == {"assignments"}, "an assignment is restored by itself"


@pytest.mark.parametrize("kind", BIN_KINDS, ids=lambda kind: kind.kind)
def test_a_kind_is_found_by_the_name_that_the_audit_trail_has(kind: BinKind) -> None:
    assert find_kind(kind.kind) is kind


def test_an_unknown_kind_is_refused_with_those_that_there_are() -> None:
    with pytest.raises(NotFoundError, match="recording, track, scan, moving_scan, hand_model"):
        find_kind("dream")


def test_what_is_restored_is_there_again_and_the_trail_says_who_did_it(database: Database) -> None:
    kind = find_kind("hand_model")
    row = HandModelRow(name="hand", kind="trained", side="right", digest="0" * 64, facts={}, deleted_at=utc_now())
    with database.writing() as session:
        session.add(row)
        session.flush()
        assert is_deleted(session, kind, row.id)
        kind.restore(session, session.get_one(Account, LOCAL_ACCOUNT_ID), row.id)
        assert not is_deleted(session, kind, row.id)
        acts = [(line.act, line.account_id) for line in session.query(AuditRow).filter_by(subject_id=row.id)]
    assert acts == [("hand_model.restore", LOCAL_ACCOUNT_ID)]
