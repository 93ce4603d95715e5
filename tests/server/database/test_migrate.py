"""Migrations on both databases."""

from __future__ import annotations

import uuid
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path

import pytest
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from sqlalchemy import bindparam, insert, inspect, select, text

from server.access.models import LOCAL_ACCOUNT_ID, Account
from server.annotations.models import AnnotationRow
from server.database import Base, Database, utc_now
from server.database.migrate import SCRIPTS, downgrade, find_current, find_head, upgrade
from server.settings import Settings
from server.tracks.cameras import digest_cameras

for path in sorted((Path(SCRIPTS).parent / "server").glob("*/*models.py")):
    import_module(f"server.{path.parent.name}.{path.stem}")  # they declare the tables


def own_tables(database: Database) -> set[str]:
    return {name for name in inspect(database.engine).get_table_names() if name != "alembic_version"}


@pytest.fixture
def database(empty_database: Database) -> Database:
    """Migrated here and now."""
    upgrade(empty_database)
    return empty_database


def test_migrations_make_exactly_the_tables_that_the_code_declares(database: Database) -> None:
    with database.engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        assert compare_metadata(context, Base.metadata) == []
        assert find_current(connection) == find_head()


def test_migrations_go_down_to_nothing_and_up_again(database: Database) -> None:
    downgrade(database, "base")
    assert own_tables(database) == set()
    upgrade(database)
    assert own_tables(database) == set(Base.metadata.tables)


def test_every_migration_can_be_taken_back_alone(empty_database: Database) -> None:
    revisions = sorted(path.name.split("_")[0] for path in Path(SCRIPTS, "versions").glob("0*.py"))
    for previous, revision in zip(["base", *revisions], revisions, strict=False):
        upgrade(empty_database, revision)
        tables = own_tables(empty_database)
        downgrade(empty_database, previous)
        upgrade(empty_database, revision)
        assert own_tables(empty_database) == tables


def test_processes_that_start_together_migrate_once(empty_database_url: str) -> None:
    databases = [Database(Settings(database_url=empty_database_url).sqlalchemy_url) for _ in range(4)]
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(upgrade, databases))
    with databases[0].reading() as session:
        assert session.scalars(select(Account.id)).all() == [LOCAL_ACCOUNT_ID]
    for database in databases:
        database.close()


def test_a_migration_that_fails_leaves_the_tables_as_they_were(empty_database: Database) -> None:
    with empty_database.writing() as session:
        session.connection().exec_driver_sql("CREATE TABLE annotations (id INTEGER)")
    with pytest.raises(Exception, match="already exists"):
        upgrade(empty_database)
    assert own_tables(empty_database) == {"annotations"}


def test_what_was_stored_before_survives_the_newest_migrations(empty_database: Database) -> None:
    upgrade(empty_database, "0002")
    now = "2026-01-01 00:00:00+00:00"
    with empty_database.writing() as session:
        run = session.connection().exec_driver_sql
        ids = [f"'{uuid.UUID(int=n).hex}'" for n in range(4)]
        local = f"'{LOCAL_ACCOUNT_ID.hex}'"
        run(
            f"INSERT INTO sequences VALUES ({ids[0]}, 'ball', 30, 9, '[]', '[]', '[]', NULL, 'key', 1,"
            f" '{now}', '{now}', NULL, {local})"
        )
        run(f"INSERT INTO annotations VALUES ({ids[1]}, {ids[0]}, 'cam0', 3, 'right', '[]', 2, '{now}', {local})")
        run(f"INSERT INTO annotation_revisions VALUES ({ids[2]}, {ids[1]}, 2, {ids[3]}, 'put', '[]', '{now}', {local})")
    upgrade(empty_database)
    downgrade(empty_database, "0002")
    upgrade(empty_database)
    with empty_database.reading() as session:
        kept = session.scalars(select(AnnotationRow)).one()
        assert (kept.frame, kept.replica, kept.author_id) == (3, "", LOCAL_ACCOUNT_ID)
        account = session.get(Account, LOCAL_ACCOUNT_ID)
        assert account is not None and account.role == "admin" and account.preferences == {}


def test_tracks_from_before_are_told_with_which_cameras_they_were_made(empty_database: Database) -> None:
    upgrade(empty_database, "0015")
    before, after = ([{"K": [[f]], "distortion": [], "T_world_camera": [[1]]}] for f in (500, 501))
    recording = uuid.UUID(int=1)
    sequences, tracks, refinements = (Base.metadata.tables[name] for name in ("sequences", "tracks", "refinements"))
    shared = {"name": "ball", "hands": [], "created_at": datetime(2026, 1, 1, tzinfo=UTC)}
    of_recording = {"fps": 30, "frame_count": 9, "objects": [], "content_key": "key", "revision": 2}
    moments = {"early": datetime(2026, 1, 2, tzinfo=UTC), "late": datetime(2026, 1, 4, tzinfo=UTC)}
    with empty_database.writing() as session:
        values = shared | of_recording | {"id": recording, "cameras": after, "updated_at": utc_now()}
        session.execute(insert(sequences).values(**values))
        for name, moment in moments.items():
            own = {"frame_first": 0, "frame_count": 9, "summary": {}, "sequence_id": recording}
            columns = shared | own | {"id": uuid.uuid4(), "name": name, "created_at": moment}
            names, marks = ", ".join(columns), ", ".join(f":{column}" for column in columns)
            types = [bindparam(column, type_=tracks.c[column].type) for column in columns]
            session.execute(text(f"INSERT INTO tracks ({names}) VALUES ({marks})").bindparams(*types), columns)
        session.execute(
            insert(refinements).values(
                **{"id": uuid.uuid4(), "sequence_id": recording, "state": "taken", "report": {}},
                **{"cameras_before": before, "cameras_after": after, "created_at": moments["early"]},
                changed_at=datetime(2026, 1, 3, tzinfo=UTC),
            )
        )
    upgrade(empty_database)
    with empty_database.reading() as session:
        rows = session.execute(select(tracks.c.name, tracks.c.cameras_digest)).all()
    assert dict(map(tuple, rows)) == {"early": digest_cameras(before), "late": digest_cameras(after)}
