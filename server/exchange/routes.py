"""Labels to and from the formats of others."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

from fastapi import APIRouter, Query, Request, Response

from server.access.service import CurrentAccount, LeadAccount
from server.annotations.schemas import SOURCES_HELP, SourceChoice
from server.compute import ComputeDep
from server.database import Database, DatabaseDep
from server.download import make_file_name, name_download
from server.errors import InvalidError, error_responses
from server.exchange import importing
from server.exchange.describe import describe_imported, describe_report
from server.exchange.exporting import ExportChoice, LabelFile, export
from server.exchange.schemas import (
    ExportNotes,
    LabelFormatOut,
    LabelFormats,
    LabelImportDone,
    LabelImportOptions,
    LabelImportReport,
)
from server.sequences.service import get_sequence
from server.storage import Storage, StorageDep
from server.storage.sent_json import read_options, reading_json
from server.storage.upload import Upload, UploadLimits, work_on_upload
from server.storage.upload_body import describe_upload_body
from tracker.label_formats import JOINT_ORDERS, LABEL_FORMATS, ImportHints

router = APIRouter(tags=["labels"], responses=error_responses(404))

AREA = "label_uploads"
LIMITS = UploadLimits(files=100_000, total_bytes=256 * 1024 * 1024)
MAX_RECORDINGS = 100
MEDIA_TYPES = {".json": "application/json", ".csv": "text/csv; charset=utf-8", ".zip": "application/zip"}

_FILES = "The files, each file name its relative path; or one .zip."
_OPTIONS = {"type": "string", "description": "LabelImportOptions as JSON: what the files do not say."}
_CHECK_BODY = describe_upload_body(_FILES, options=_OPTIONS)
_IMPORT_BODY = describe_upload_body(
    _FILES,
    options=_OPTIONS,
    check={"type": "string", "description": "`check` of the report that is confirmed."},
    policy={"type": "string", "enum": ["keep", "replace"], "description": "Of hands that have other labels."},
)
FormatQuery = Annotated[str, Query(alias="format", max_length=40, description="One of `/label-formats`.")]
SnapshotQuery = Annotated[uuid.UUID | None, Query(description="Labels of this snapshot instead of those of now.")]
TrackQuery = Annotated[
    uuid.UUID | None, Query(description="For formats in 3D: take the joints in space from this track of the recording.")
]
SourceQuery = Annotated[list[SourceChoice], Query(min_length=1, max_length=10, description=SOURCES_HELP)]
ALL: list[SourceChoice] = ["all"]
SequencesQuery = Annotated[
    list[uuid.UUID],
    Query(
        alias="sequence_id",
        min_length=1,
        max_length=MAX_RECORDINGS,
        description="Each once.",
        json_schema_extra={"uniqueItems": True},
    ),
]


@router.get("/label-formats")
def list_label_formats() -> LabelFormats:
    """Formats that labels can be exported to and imported from, and what each of them loses."""
    items = [LabelFormatOut.model_validate(item) for item in LABEL_FORMATS.values()]
    return LabelFormats(items=items, joint_orders=list(JOINT_ORDERS))


_KINDS = sorted({MEDIA_TYPES[Path(kind.file).suffix] for kind in LABEL_FORMATS.values()})
_FILE: dict[int | str, dict[str, Any]] = {
    200: {
        "content": {
            kind: {} if kind == "application/json" else {"schema": {"type": "string", "format": "binary"}}
            for kind in _KINDS
        }
    }
}


@router.get(
    "/sequences/{sequence_id}/labels/export", response_class=Response, responses=_FILE | error_responses(403, 409)
)
def export_recording_labels(
    sequence_id: uuid.UUID,
    database: DatabaseDep,
    compute: ComputeDep,
    account: CurrentAccount,
    format_: FormatQuery,
    snapshot_id: SnapshotQuery = None,
    track_id: TrackQuery = None,
    source: SourceQuery = ALL,
) -> Response:
    """The labels of a recording in a format, as one file: a zip where the format has several."""
    made = compute.ask(export, account, [sequence_id], ExportChoice(format_, source, snapshot_id, track_id))
    return _answer(database, made, format_, [sequence_id])


@router.get("/sequences/{sequence_id}/labels/export/notes", responses=error_responses(403, 409))
def preview_export(
    sequence_id: uuid.UUID,
    database: DatabaseDep,
    compute: ComputeDep,
    account: CurrentAccount,
    format_: FormatQuery,
    snapshot_id: SnapshotQuery = None,
    track_id: TrackQuery = None,
    source: SourceQuery = ALL,
) -> ExportNotes:
    """What the export would hold and what would be lost in it."""
    made = compute.ask(export, account, [sequence_id], ExportChoice(format_, source, snapshot_id, track_id))
    return ExportNotes(
        format=format_,
        file=make_file_name(_name_export(database, format_, [sequence_id]), Path(LABEL_FORMATS[format_].file).suffix),
        items=made.items,
        joints=made.joints,
        bytes=len(made.data),
        notes=list(made.notes),
    )


@router.get("/labels/export", response_class=Response, responses=_FILE | error_responses(403, 409))
def export_several(
    database: DatabaseDep,
    compute: ComputeDep,
    account: CurrentAccount,
    format_: FormatQuery,
    sequence_ids: SequencesQuery,
    source: SourceQuery = ALL,
) -> Response:
    """The labels of several recordings in one file, in a format that can hold several."""
    if len(set(sequence_ids)) != len(sequence_ids):
        raise InvalidError("A recording is named twice.")
    made = compute.ask(export, account, sequence_ids, ExportChoice(format_, source))
    return _answer(database, made, format_, sequence_ids)


def _answer(database: Database, made: LabelFile, format_: str, ids: Sequence[uuid.UUID]) -> Response:
    suffix = Path(LABEL_FORMATS[format_].file).suffix
    headers = name_download(*_name_export(database, format_, ids), suffix=suffix)
    return Response(made.data, media_type=MEDIA_TYPES[suffix], headers=headers)


def _name_export(database: Database, format_: str, ids: Sequence[uuid.UUID]) -> list[str]:
    """What a file of exported labels is called after: the recording, how many more there are, the format."""
    with database.reading() as session:
        first = get_sequence(session, ids[0]).name
    others = [f"and {len(ids) - 1} more"] if len(ids) > 1 else []
    return [first, *others, Path(LABEL_FORMATS[format_].file).stem]


@router.post(
    "/sequences/{sequence_id}/labels/check", responses=error_responses(403, 413, 507), openapi_extra=_CHECK_BODY
)
async def check_recording_labels(
    sequence_id: uuid.UUID,
    request: Request,
    database: DatabaseDep,
    storage: StorageDep,
    account: LeadAccount,
) -> LabelImportReport:
    """Check files of labels: what is new, what differs, what is lost. Nothing is stored."""
    return await _check([sequence_id], request, database, storage, account)


@router.post(
    "/sequences/{sequence_id}/labels/import", responses=error_responses(403, 409, 413, 507), openapi_extra=_IMPORT_BODY
)
async def import_recording_labels(
    sequence_id: uuid.UUID,
    request: Request,
    database: DatabaseDep,
    storage: StorageDep,
    account: LeadAccount,
) -> LabelImportDone:
    """Import files of labels into a recording, as their report said: with its `check`, and a `policy` for conflicts."""
    return await _import([sequence_id], request, database, storage, account)


@router.post("/labels/check", responses=error_responses(403, 413, 507), openapi_extra=_CHECK_BODY)
async def check_several(
    request: Request,
    database: DatabaseDep,
    storage: StorageDep,
    account: LeadAccount,
    sequence_ids: SequencesQuery,
) -> LabelImportReport:
    """Check files with labels of several recordings. Nothing is stored."""
    return await _check(sequence_ids, request, database, storage, account)


@router.post("/labels/import", responses=error_responses(403, 409, 413, 507), openapi_extra=_IMPORT_BODY)
async def import_several(
    request: Request,
    database: DatabaseDep,
    storage: StorageDep,
    account: LeadAccount,
    sequence_ids: SequencesQuery,
) -> LabelImportDone:
    """Import labels of several recordings: into all of them or none."""
    return await _import(sequence_ids, request, database, storage, account)


async def _check(
    ids: Sequence[uuid.UUID], request: Request, database: Database, storage: Storage, account: Any
) -> LabelImportReport:
    def work(folder: Path, upload: Upload) -> LabelImportReport:
        with database.reading() as session:
            rows = [get_sequence(session, id_) for id_ in dict.fromkeys(ids)]
        labels = _read(storage, folder, rows, upload.fields)
        with database.reading() as session:
            return describe_report(labels, importing.plan_import(session, rows, labels, account))

    return await work_on_upload(request, storage, AREA, LIMITS, work)


async def _import(
    ids: Sequence[uuid.UUID], request: Request, database: Database, storage: Storage, account: Any
) -> LabelImportDone:
    def work(folder: Path, upload: Upload) -> LabelImportDone:
        policy, check = upload.fields.get("policy", ""), upload.fields.get("check", "")
        if policy not in ("keep", "replace"):
            raise InvalidError(f"The field `policy` is {policy[:40]!r}; needed keep or replace.")
        if not check:
            raise InvalidError("The field `check` is missing: first have the files checked, then send that `check`.")
        with database.reading() as session:
            rows = [get_sequence(session, id_) for id_ in dict.fromkeys(ids)]
        labels = _read(storage, folder, rows, upload.fields)
        with database.writing() as session:
            done = importing.apply_import(session, storage, rows, labels, account, policy, check)
            return LabelImportDone(format=labels.format, recordings=describe_imported(session, done))

    return await work_on_upload(request, storage, AREA, LIMITS, work)


def _read(storage: Storage, folder: Path, rows: Any, fields: dict[str, str]) -> importing.ReadLabels:
    options = parse_options(fields.get("options", ""))
    hints = ImportHints(options.hand, options.camera, options.pixel_centre, options.joint_order)
    files = [path for path in folder.rglob("*") if path.is_file()]
    return importing.read_files(storage, files[0] if len(files) == 1 else folder, rows, options.format, hints)


def parse_options(text: str) -> LabelImportOptions:
    """Options from a form's field: a JSON object, or nothing."""
    with reading_json("The field `options`", "options of an import of labels"):
        return LabelImportOptions.model_validate(read_options(text))
