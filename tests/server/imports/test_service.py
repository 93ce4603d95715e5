"""An upload is checked, checked again, confirmed once or dropped, and never becomes half a recording."""

from __future__ import annotations

import os
import uuid
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from sqlalchemy import select
from sqlalchemy.exc import IntegrityError

from server.access.models import LOCAL_ACCOUNT_ID, AuditRow
from server.database import Database, utc_now
from server.errors import ConflictError, InvalidError, NotFoundError
from server.imports import service
from server.imports.models import ImportRow
from server.imports.service import ImportContext
from server.sequences.models import SequenceRow
from server.settings import Settings
from server.storage import Storage
from tests.server.conftest import MakeRecording
from tracker.errors import ImportRefusedError

Send = Callable[..., ImportRow]


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def desk(database: Database, settings: Settings) -> ImportContext:
    return ImportContext(database, Storage(settings.data_dir), settings)


@pytest.fixture
def send(desk: ImportContext, make_recording: MakeRecording) -> Send:
    """Uploads a recording of three frames."""
    numbers = iter(range(100))

    def add(options: str = "", **more: Any) -> ImportRow:
        source = make_recording(f"waving{next(numbers)}", **more)
        import_id = uuid.uuid4()
        upload = service.begin_upload(desk, import_id)
        for path in sorted(path for path in source.rglob("*") if path.is_file()):
            with upload.begin_file(f"waving/{path.relative_to(source)}") as file:
                file.write(path.read_bytes())
        upload.fields["options"] = options
        return service.add_import(desk, import_id, upload, LOCAL_ACCOUNT_ID)

    return add


def kept(desk: ImportContext, area: str) -> list[uuid.UUID]:
    return desk.storage.list_ids(area)


def test_an_upload_is_named_by_its_folder_or_as_was_said(desk: ImportContext, send: Send) -> None:
    assert (send().name, send('{"name": " Ada "}').name) == ("waving", "Ada")
    row = send()
    assert (row.state, row.file_count, row.report["problems"]) == ("checked", 7, [])
    assert str(desk.storage.root) not in str(row.report), "nobody learns where the studio keeps files"


def test_an_upload_without_files_is_refused(desk: ImportContext) -> None:
    import_id = uuid.uuid4()
    with pytest.raises(InvalidError, match=r"The upload holds no files. Choose the recording's folder"):
        service.add_import(desk, import_id, service.begin_upload(desk, import_id), LOCAL_ACCOUNT_ID)


def test_other_options_are_another_report_and_the_name_stays_unless_it_is_said(desk: ImportContext, send: Send) -> None:
    row = send()
    again = service.check_again(desk, row.id, {"hands": ["left"]})
    assert (again.name, again.options, again.state) == ("waving", {"hands": ["left"]}, "checked")
    assert service.check_again(desk, row.id, {"name": "Bo"}).name == "Bo"
    with pytest.raises(ImportRefusedError, match="unknown color; known: allow_gaps"):
        service.check_again(desk, row.id, {"color": "red"})
    assert service.get_import(desk, row.id).options == {"name": "Bo"}


def test_a_confirmed_upload_is_a_recording_once_and_its_files_are_gone(desk: ImportContext, send: Send) -> None:
    row = send()
    made = service.confirm_import(desk, row.id, "Ada", LOCAL_ACCOUNT_ID, seen={})
    again = service.confirm_import(desk, row.id, "Other", LOCAL_ACCOUNT_ID)
    assert (made.id, made.name, made.frame_count) == (again.id, "Ada", 3) and again.name == "Ada"
    assert kept(desk, "sequences") == [made.id] and kept(desk, "uploads") == []
    for act in (lambda: service.check_again(desk, row.id, {}), lambda: service.drop_import(desk, row.id)):
        with pytest.raises(ConflictError, match=r"has become a recording already. Change or delete the recording"):
            act()
    with desk.database.reading() as session:
        [line] = session.scalars(select(AuditRow))
    assert (line.act, line.subject_id, line.detail) == ("recording.import", made.id, {"name": "Ada"})


def test_options_that_somebody_else_gave_meanwhile_are_not_confirmed_unseen(desk: ImportContext, send: Send) -> None:
    row = send()
    service.check_again(desk, row.id, {"hands": ["left"]})
    with pytest.raises(ConflictError, match="checked this upload with other options meanwhile; nothing was stored"):
        service.confirm_import(desk, row.id, None, LOCAL_ACCOUNT_ID, seen={})
    assert kept(desk, "sequences") == []
    made = service.confirm_import(desk, row.id, None, LOCAL_ACCOUNT_ID, seen={"hands": ["left"]})
    assert made.hands == ["left"]


def test_a_refused_upload_is_not_confirmed(desk: ImportContext) -> None:
    import_id = uuid.uuid4()
    upload = service.begin_upload(desk, import_id)
    with upload.begin_file("notes.txt") as file:
        file.write(b"no recording")
    row = service.add_import(desk, import_id, upload, LOCAL_ACCOUNT_ID)
    assert (row.state, row.name) == ("refused", "notes") and row.report["problems"]
    with pytest.raises(ConflictError, match=r"The upload was refused; its report says why. Check it again"):
        service.confirm_import(desk, row.id, None, LOCAL_ACCOUNT_ID)


def test_a_recording_whose_rows_cannot_be_stored_leaves_no_files(
    desk: ImportContext, make_recording: MakeRecording
) -> None:
    with pytest.raises(IntegrityError):
        service.import_recording(desk, make_recording(), {}, uuid.uuid4())
    assert kept(desk, "sequences") == []
    with desk.database.reading() as session:
        assert session.scalars(select(SequenceRow)).all() == []


def test_an_upload_that_was_dropped_meanwhile_becomes_no_recording(desk: ImportContext, send: Send) -> None:
    row = send()
    source = desk.source(row.id) / "waving"
    with desk.database.writing() as session:
        session.delete(session.get_one(ImportRow, row.id))
    with pytest.raises(ConflictError, match="The upload was imported or dropped meanwhile"):
        service.import_recording(desk, source, {}, LOCAL_ACCOUNT_ID, import_id=row.id)
    assert kept(desk, "sequences") == []


def test_a_dropped_upload_is_not_found_any_more(desk: ImportContext, send: Send) -> None:
    row, other = send(), send()
    service.drop_import(desk, row.id)
    assert kept(desk, "uploads") == [other.id]
    with pytest.raises(NotFoundError, match=f"There is no upload {row.id}; it was dropped, or removed after it had"):
        service.get_import(desk, row.id)


def test_uploads_that_waited_too_long_or_never_arrived_are_removed(desk: ImportContext, send: Send) -> None:
    old, fresh, done = send(), send(), send()
    service.confirm_import(desk, done.id, None, LOCAL_ACCOUNT_ID)
    broken, arriving = uuid.uuid4(), uuid.uuid4()
    for import_id in (broken, arriving):
        service.begin_upload(desk, import_id)
    long_ago = utc_now() - timedelta(hours=desk.settings.abandoned_import_hours + 1)
    for import_id in (broken, fresh.id):
        os.utime(desk.folder(import_id), (long_ago.timestamp(), long_ago.timestamp()))
    with desk.database.writing() as session:
        for id_ in (old.id, done.id):
            session.get_one(ImportRow, id_).updated_at = long_ago
    assert service.remove_abandoned(desk) == 2
    assert set(kept(desk, "uploads")) == {fresh.id, arriving}
    with desk.database.reading() as session:
        assert {row.id: row.state for row in session.scalars(select(ImportRow))} == {
            fresh.id: "checked",
            done.id: "confirmed",
        }
    assert service.remove_abandoned(desk) == 0


@pytest.mark.parametrize(
    ("names", "proposed"),
    [
        (["wave/a.png", "wave/b/c.png"], "wave"),
        (["film.avi"], "film"),
        (["a.png", "b.png"], "recording"),
        (["v1.2/a.png", "v1.2/b.png"], "v1.2"),
        ([" \u202e/a.png", " \u202e/b.png"], "recording"),
        ([], "recording"),
    ],
)
def test_a_name_is_proposed_from_what_all_files_have_in_common(names: list[str], proposed: str) -> None:
    assert service.propose_name(names) == proposed


@given(st.lists(st.builds(str.__mul__, st.text(max_size=5), st.integers(1, 60)), max_size=3))
def test_a_proposed_name_can_always_be_stored_and_read(names: list[str]) -> None:
    name = service.propose_name(names)
    assert 0 < len(name) <= 200 and name.isprintable()


@pytest.mark.parametrize("text", ["[]", "{", '{"fps": "quick"}', '{"wings": 2}'])
def test_options_that_are_none_are_refused(text: str) -> None:
    with pytest.raises((InvalidError, ImportRefusedError)):
        service.parse_options(text)
    assert service.parse_options("") == {} and service.parse_options('{"fps": 25}') == {"fps": 25}


def test_a_folder_is_only_read(desk: ImportContext, make_recording: MakeRecording) -> None:
    source = make_recording()
    before = {path: path.read_bytes() for path in Path(source).rglob("*") if path.is_file()}
    service.import_recording(desk, source, {"name": "Ada"}, LOCAL_ACCOUNT_ID)
    assert {path: path.read_bytes() for path in Path(source).rglob("*") if path.is_file()} == before
