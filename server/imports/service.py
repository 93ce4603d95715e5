"""Uploads become recordings: checked first, then moved in whole or not at all.

Files are read and written for seconds to minutes here, so the functions take the database and keep their transactions
short, instead of working inside the request's.
"""

from __future__ import annotations

import dataclasses
import json
import shutil
import threading
import uuid
from datetime import timedelta
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, Any
from weakref import WeakValueDictionary

from sqlalchemy import delete, select, update

from server.access.audit import record_act
from server.annotations.changes import add_imported_annotations
from server.database import Database, utc_now
from server.errors import ConflictError, InvalidError, NotFoundError
from server.imports.models import ImportRow
from server.imports.probes import find_probes, forget_probes
from server.sequences import service as sequences
from server.sequences.models import SequenceRow
from server.settings import Settings
from server.storage import Storage
from server.storage.sent_json import read_options
from server.storage.upload import Upload
from tracker import TrackerError, load_annotations
from tracker.capture import ArchiveLimits, ImportOptions, ImportReport, check_import, extract_archive, run_import

if TYPE_CHECKING:
    from tracker import ObjectSize

AREA = "uploads"
FILES, UNPACKED = "files", "unpacked"


@dataclasses.dataclass(frozen=True)
class ImportContext:
    """Where imports are worked on."""

    database: Database
    storage: Storage
    settings: Settings

    def folder(self, import_id: uuid.UUID) -> Path:
        """Folder of an upload."""
        return self.storage.folder(AREA, import_id)

    def source(self, import_id: uuid.UUID) -> Path:
        """Folder of its files, unpacked if they came packed."""
        folder = self.folder(import_id)
        return folder / UNPACKED if (folder / UNPACKED).exists() else folder / FILES


def begin_upload(context: ImportContext, import_id: uuid.UUID) -> Upload:
    """Make room for an upload."""
    folder = context.folder(import_id) / FILES
    folder.mkdir(parents=True)
    return Upload(folder, context.settings.max_upload_files, context.settings.max_upload_bytes)


def drop_files(context: ImportContext, import_id: uuid.UUID) -> None:
    """Remove an upload's files."""
    context.storage.remove(AREA, import_id)


def add_import(context: ImportContext, import_id: uuid.UUID, upload: Upload, account_id: uuid.UUID) -> ImportRow:
    """Look at an upload that has arrived whole, and note what was found."""
    if not upload.names:
        raise InvalidError("The upload holds no files. Choose the recording's folder, its files, or a zip of them.")
    options = parse_options(upload.fields.get("options", ""))
    _unpack(context, import_id, upload)
    name = (options.get("name") or propose_name(upload.names)).strip()
    report = _check(context, import_id, options, name)
    row = ImportRow(
        id=import_id,
        state="checked" if report["ok"] else "refused",
        name=name,
        options=options,
        report=report,
        file_count=len(upload.names),
        byte_count=upload.byte_count,
        created_by=account_id,
    )
    with context.database.writing() as session:
        session.add(row)
    return row


def get_import(context: ImportContext, import_id: uuid.UUID) -> ImportRow:
    """The import of this id."""
    with context.database.reading() as session:
        row = session.get(ImportRow, import_id)
    if row is None:
        raise NotFoundError(f"There is no upload {import_id}; it was dropped, or removed after it had waited too long.")
    return row


def check_again(context: ImportContext, import_id: uuid.UUID, options: dict[str, Any]) -> ImportRow:
    """Look at an upload with other options."""
    row = get_open(context, import_id)
    ImportOptions.from_json(options)
    name = (options.get("name") or row.name).strip()
    report = _check(context, import_id, options, name)
    state = "checked" if report["ok"] else "refused"
    changes = {"state": state, "name": name, "options": options, "report": report, "updated_at": utc_now()}
    with context.database.writing() as session:
        query = update(ImportRow).where(ImportRow.id == import_id, ImportRow.state != "confirmed").values(changes)
        if session.connection().execute(query).rowcount != 1:
            raise ConflictError("The upload was imported or dropped meanwhile.")
    return get_import(context, import_id)


_GUARD = threading.Lock()
_CONFIRMING: WeakValueDictionary[uuid.UUID, threading.Lock] = WeakValueDictionary()
"""Of the uploads that are being confirmed; who comes second would read files that the first one drops."""


def confirm_import(
    context: ImportContext,
    import_id: uuid.UUID,
    name: str | None,
    account_id: uuid.UUID,
    seen: dict[str, Any] | None = None,
) -> SequenceRow:
    """Make an upload a recording. Asked again, it gives the same recording; asked twice at once, one waits.

    With `seen`, only as it was checked with these options.
    """
    with _GUARD:
        lock = _CONFIRMING.setdefault(import_id, threading.Lock())
    with lock:
        return _confirm(context, import_id, name, account_id, seen)


def _confirm(
    context: ImportContext, import_id: uuid.UUID, name: str | None, account_id: uuid.UUID, seen: dict[str, Any] | None
) -> SequenceRow:
    row = get_import(context, import_id)
    if row.state == "checked" and seen is not None and seen != row.options:
        raise ConflictError(
            "Somebody checked this upload with other options meanwhile; nothing was stored. Look at the new report."
        )
    if row.state == "refused":
        raise ConflictError("The upload was refused; its report says why. Check it again with other options.")
    if row.state == "checked":
        options = row.options | {"name": name or row.name}
        try:
            import_recording(context, context.source(import_id), options, account_id, import_id=import_id)
        except (ConflictError, TrackerError):  # somebody who confirmed it too may have been quicker
            if get_import(context, import_id).state != "confirmed":
                raise
        drop_files(context, import_id)
        forget_probes(import_id)
        row = get_import(context, import_id)
    assert row.sequence_id is not None
    with context.database.reading() as session:
        return sequences.get_sequence(session, row.sequence_id)


def import_recording(
    context: ImportContext,
    source: Path,
    options: dict[str, Any],
    account_id: uuid.UUID,
    *,
    import_id: uuid.UUID | None = None,
) -> uuid.UUID:
    """Import a folder: its files first, then its rows in one transaction; without the rows, no files.

    Args:
        context: Where to.
        source: Folder or video; only read.
        options: What the files do not tell, with `format` when it is not to be recognised.
        account_id: Who.
        import_id: The upload that this confirms; a second one that confirms it finds itself too late.

    Returns:
        Id of the recording.
    """
    sequence_id = uuid.uuid4()
    folder = context.storage.folder(sequences.AREA, sequence_id)
    told = ImportOptions.from_json(options)
    report = run_import(source, folder, options.get("format"), told, measure=measure_mesh)
    try:
        recording = sequences.open_sequence(context.storage, sequence_id)
        columns = sequences.describe_recording(recording)
        path = recording.annotations_path
        annotations = load_annotations(path) if path is not None and path.exists() else None
        context.storage.publish(sequences.AREA, sequence_id)
        with context.database.writing() as session:
            row = sequences.add_sequence(session, sequence_id, columns, _clean(report, source), account_id)
            record_act(session, account_id, "recording.import", "recording", sequence_id, name=row.name)
            if annotations is not None:
                add_imported_annotations(session, row, annotations, account_id)
            if import_id is not None:
                query = update(ImportRow).where(ImportRow.id == import_id, ImportRow.state == "checked")
                done = query.values(state="confirmed", sequence_id=sequence_id, updated_at=utc_now())
                if session.connection().execute(done).rowcount != 1:
                    raise ConflictError("The upload was imported or dropped meanwhile.")
    except BaseException:
        context.storage.remove(sequences.AREA, sequence_id)
        raise
    return sequence_id


def drop_import(context: ImportContext, import_id: uuid.UUID) -> None:
    """Forget an upload."""
    get_open(context, import_id)
    with context.database.writing() as session:
        session.execute(delete(ImportRow).where(ImportRow.id == import_id, ImportRow.state != "confirmed"))
    drop_files(context, import_id)
    forget_probes(import_id)


def remove_abandoned(context: ImportContext) -> int:
    """Remove uploads that nobody confirmed for long, and those that never arrived whole; gives their number."""
    oldest = utc_now() - timedelta(hours=context.settings.abandoned_import_hours)
    with context.database.writing() as session:
        query = select(ImportRow).where(ImportRow.state != "confirmed", ImportRow.updated_at < oldest)
        abandoned = {row.id for row in session.scalars(query)}
        session.execute(delete(ImportRow).where(ImportRow.id.in_(abandoned)))
        waiting = set(session.scalars(select(ImportRow.id).where(ImportRow.state != "confirmed")))
    for import_id in context.storage.list_ids(AREA):
        try:
            is_old = context.folder(import_id).stat().st_mtime < oldest.timestamp()
        except FileNotFoundError:
            continue
        if import_id in abandoned or (import_id not in waiting and is_old):
            drop_files(context, import_id)
            abandoned.add(import_id)
    context.storage.sweep(AREA)
    return len(abandoned)


def parse_options(text: str) -> dict[str, Any]:
    """Options from a form's field: a JSON object, or nothing."""
    options = read_options(text)
    ImportOptions.from_json(options)
    return options


def propose_name(names: list[str]) -> str:
    """A name for a recording from those of its files: the folder that all lie in, or the file if it is the only one."""
    tops = {name.split("/")[0] for name in names}
    top = tops.pop() if len(tops) == 1 else ""
    name = PurePosixPath(top).stem if top and len(names) == 1 else top
    return "".join(c for c in name if c.isprintable()).strip()[:200] or "recording"


def _unpack(context: ImportContext, import_id: uuid.UUID, upload: Upload) -> None:
    """Unpack an upload that is one archive."""
    if len(upload.names) != 1 or not upload.names[0].lower().endswith(".zip"):
        return
    limits = ArchiveLimits(files=context.settings.max_upload_files, total_bytes=context.settings.max_upload_bytes)
    extract_archive(upload.folder / upload.names[0], context.folder(import_id) / UNPACKED, limits)
    shutil.rmtree(upload.folder)


def _check(context: ImportContext, import_id: uuid.UUID, options: dict[str, Any], name: str) -> dict[str, Any]:
    source = context.source(import_id)
    known = find_probes(import_id)
    told = ImportOptions.from_json(options | {"name": name})
    report = check_import(source, options.get("format"), told, known, measure_mesh)
    return _clean(report, source)


def measure_mesh(path: Path) -> ObjectSize | None:
    """The size of an object's model; recordings without objects do without what reads them."""
    from tracker import measure_model

    return measure_model(path)


def _clean(report: ImportReport, source: Path) -> dict[str, Any]:
    """The report without the place where the studio keeps the files."""
    text = json.dumps(report.to_json(), allow_nan=False)
    return json.loads(text.replace(json.dumps(f"{source}/")[1:-1], ""))


def get_open(context: ImportContext, import_id: uuid.UUID) -> ImportRow:
    row = get_import(context, import_id)
    if row.state == "confirmed":
        raise ConflictError("The upload has become a recording already. Change or delete the recording instead.")
    return row
