"""`/imports`."""

from __future__ import annotations

import uuid
from dataclasses import fields
from typing import Annotated, Any, get_type_hints

from anyio import CancelScope
from fastapi import APIRouter, Depends, Query, Request, Response
from starlette.concurrency import run_in_threadpool
from starlette.requests import HTTPConnection

from server.access.service import AccountIdDep, require_lead
from server.database import DatabaseDep
from server.errors import TooLargeError, error_responses
from server.imports import service
from server.imports.models import ImportRow
from server.imports.pictures import make_picture
from server.imports.schemas import (
    OPTIONS_HELP,
    ImportCalibration,
    ImportCheck,
    ImportConfirm,
    ImportField,
    ImportForm,
    ImportOut,
    SensorPresetOut,
)
from server.imports.service import ImportContext
from server.imports.taken_cameras import take_cameras
from server.sequences.schemas import SequenceOut
from server.sequences.summaries import SummariesDep, describe_sequences
from server.storage import StorageDep
from server.storage.upload import receive_upload
from server.storage.upload_body import describe_upload_body
from tracker.capture import IMPORT_FORMATS, SENSOR_PRESETS, ImportOptions

router = APIRouter(prefix="/imports", tags=["imports"], responses=error_responses())

by_lead = [Depends(require_lead)]

_BODY = describe_upload_body(
    "The recording's files, each file name its relative path; or one .zip.",
    options={"type": "string", "description": f"JSON. {OPTIONS_HELP}"},
)


def get_import_context(connection: HTTPConnection, database: DatabaseDep, storage: StorageDep) -> ImportContext:
    """The app's."""
    return ImportContext(database, storage, connection.app.state.settings)


ImportContextDep = Annotated[ImportContext, Depends(get_import_context)]


@router.get("/form")
def get_import_form() -> ImportForm:
    """Options of an import, for what its files do not say."""
    hints = get_type_hints(ImportOptions)
    options = [
        ImportField(name=item.name, type=_name_type(hints[item.name]), help=item.metadata.get("help", ""))
        for item in fields(ImportOptions)
    ]
    presets = [SensorPresetOut.model_validate(preset) for preset in SENSOR_PRESETS]
    return ImportForm(formats=list(IMPORT_FORMATS), options=options, presets=presets)


def _name_type(hint: Any) -> str:
    text = str(hint).replace("typing.", "")
    names = {"float": "number", "bool": "boolean", "str": "string", "int": "integer"}
    inner = next((names[name] for name in names if name in text or getattr(hint, "__name__", "") == name), "string")
    return f"{inner}[]" if "tuple" in text else inner


@router.post(
    "",
    status_code=201,
    response_model=ImportOut,
    responses=error_responses(413, 507),
    openapi_extra=_BODY,
    dependencies=by_lead,
)
async def create_import(request: Request, context: ImportContextDep, account_id: AccountIdDep) -> ImportRow:
    """Upload a recording and have it checked. Nothing becomes a recording before it is confirmed."""
    length = request.headers.get("content-length", "")
    if length.isdecimal() and int(length) > context.settings.max_upload_bytes + 2**20:
        raise TooLargeError(
            f"The upload has {length} bytes, more than {context.settings.max_upload_bytes}; "
            "HANDLOOM_MAX_UPLOAD_BYTES sets the limit."
        )
    import_id = uuid.uuid4()
    try:
        upload = await run_in_threadpool(service.begin_upload, context, import_id)
        await receive_upload(request.stream(), request.headers.get("content-type", ""), upload)
        return await run_in_threadpool(service.add_import, context, import_id, upload, account_id)
    except BaseException:  # a client that has gone, too
        with CancelScope(shield=True):
            await run_in_threadpool(service.drop_files, context, import_id)
        raise


@router.get("/{import_id}", response_model=ImportOut, responses=error_responses(404))
def get_import(import_id: uuid.UUID, context: ImportContextDep) -> ImportRow:
    """An upload and its report."""
    return service.get_import(context, import_id)


@router.get(
    "/{import_id}/picture",
    response_class=Response,
    responses=error_responses(404)
    | {200: {"content": {"image/jpeg": {"schema": {"type": "string", "format": "binary"}}}}},
)
def get_import_picture(
    import_id: uuid.UUID,
    name: Annotated[str, Query(max_length=1100, description="As in the report's `pictures`.")],
    context: ImportContextDep,
) -> Response:
    """A small picture of an image that would be imported; depth in colours, near bright and far dark."""
    service.get_import(context, import_id)
    data = make_picture(context.source(import_id), name)
    return Response(data, media_type="image/jpeg", headers={"Cache-Control": "private, max-age=86400, immutable"})


@router.post("/{import_id}/check", response_model=ImportOut, dependencies=by_lead, responses=error_responses(404, 409))
def check_import(import_id: uuid.UUID, body: ImportCheck, context: ImportContextDep) -> ImportRow:
    """Check again with other options."""
    return service.check_again(context, import_id, body.options)


@router.put(
    "/{import_id}/calibration", response_model=ImportOut, dependencies=by_lead, responses=error_responses(404, 409)
)
def take_import_cameras(import_id: uuid.UUID, body: ImportCalibration, context: ImportContextDep) -> ImportRow:
    """Take the cameras of videos from a kept calibration, and check again."""
    return take_cameras(context, import_id, body.calibration_id)


@router.post("/{import_id}/confirm", status_code=201, dependencies=by_lead, responses=error_responses(404, 409))
def confirm_import(
    import_id: uuid.UUID,
    body: ImportConfirm,
    context: ImportContextDep,
    account_id: AccountIdDep,
    summaries: SummariesDep,
) -> SequenceOut:
    """Make it a recording, whole or not at all."""
    row = service.confirm_import(context, import_id, body.name, account_id, body.options)
    with context.database.reading() as session:
        return describe_sequences(session, [row], summaries)[0]


@router.delete("/{import_id}", status_code=204, dependencies=by_lead, responses=error_responses(404, 409))
def delete_import(import_id: uuid.UUID, context: ImportContextDep) -> None:
    """Drop an upload."""
    service.drop_import(context, import_id)
