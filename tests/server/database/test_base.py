"""What every table has: a key, constraints that migrations can name, moments in UTC, and NULL for what there is not."""

from __future__ import annotations

import uuid
from datetime import UTC, datetime, timedelta, timezone

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import Uuid, text
from sqlalchemy.dialects import postgresql, sqlite

import server.app  # noqa: F401  (all tables are declared then)
from server.database import Base, Database, utc_now
from server.database.base import UtcDateTime
from tests.server.exchange.labels import make_points
from tests.server.rows import keep, make_annotation, make_recording

LONGEST_NAME = 63
"""Of PostgreSQL; it cuts what is longer, and a migration would look for the whole."""

ZONES = st.integers(-14 * 60, 14 * 60).map(lambda minutes: timezone(timedelta(minutes=minutes)))
MOMENTS = st.datetimes(datetime(1970, 1, 2), datetime(2200, 1, 1), timezones=ZONES)


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@given(MOMENTS)
def test_a_moment_is_the_same_one_in_utc_whichever_zone_it_came_from(moment: datetime) -> None:
    for dialect in (sqlite.dialect(), postgresql.dialect()):
        kept = UtcDateTime().process_bind_param(moment, dialect)
        assert kept == moment and kept.utcoffset() == timedelta(0)
        assert UtcDateTime().process_result_value(moment, dialect) == moment
        plain = UtcDateTime().process_result_value(kept.replace(tzinfo=None), dialect)
        assert plain == moment and plain.tzinfo is UTC, "SQLite keeps no zone"


def test_a_moment_without_a_zone_is_a_fault_of_ours_and_none_is_none() -> None:
    dialect = sqlite.dialect()
    with pytest.raises(AssertionError, match="a moment needs its zone"):
        UtcDateTime().process_bind_param(datetime(2026, 1, 2), dialect)
    assert UtcDateTime().process_bind_param(None, dialect) is None
    assert UtcDateTime().process_result_value(None, dialect) is None
    assert abs(utc_now() - datetime.now(UTC)) < timedelta(minutes=1)


def test_what_there_is_not_is_null_and_no_json(database: Database) -> None:
    recording = make_recording()
    keep(database, recording, make_annotation(recording, 0, None), make_annotation(recording, 1, make_points()))
    with database.reading() as session:
        empty = session.execute(text("SELECT frame, points IS NULL, sources IS NULL FROM annotations ORDER BY frame"))
        assert [tuple(row) for row in empty] == [(0, 1, 1), (1, 0, 1)]


def test_every_row_has_a_key_of_its_own_before_anything_else_is_known(database: Database) -> None:
    first, second = make_recording(id=None), make_recording(id=None)
    keep(database, first, second)
    assert isinstance(first.id, uuid.UUID) and first.id != second.id
    for table in Base.metadata.tables.values():
        assert [column.name for column in table.primary_key] == ["id"] and isinstance(table.c.id.type, Uuid)


def test_every_constraint_has_a_name_that_both_databases_keep_whole() -> None:
    for table in Base.metadata.tables.values():
        names = [str(constraint.name) for constraint in table.constraints] + [
            str(index.name) for index in table.indexes
        ]
        assert len(set(names)) == len(names), table.name
        for name in names:
            assert name[:3] in ("ix_", "uq_", "ck_", "fk_", "pk_") and table.name in name, name
            assert len(name) <= LONGEST_NAME, name


def test_rows_are_joined_by_ids_and_never_by_relationships() -> None:
    mappers = list(Base.registry.mappers)
    assert len(mappers) == len(Base.metadata.tables)
    assert [mapper for mapper in mappers if mapper.relationships] == []
