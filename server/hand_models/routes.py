"""`/hand-skeleton`, `/hand-models`."""

from __future__ import annotations

import uuid
from pathlib import Path

from fastapi import APIRouter, Depends, Request, Response

from server.access.audit import record_act
from server.access.service import AccountIdDep, LeadAccount, require_lead
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, Page
from server.deprecation import deprecated
from server.download import name_download
from server.errors import NotFoundError, error_responses
from server.hand_models import service, storing
from server.hand_models.schemas import HandModelOptions, HandModelOut, HandModelReport, HandSkeleton
from server.storage import StorageDep
from server.storage.upload import Upload, UploadLimits, work_on_upload
from server.storage.upload_body import describe_upload_body, read_one_file
from tracker import HAND_EDGES, HAND_JOINTS

router = APIRouter(tags=["hands"], responses=error_responses())

REPORT_POLICY = "sandbox; default-src 'none'; img-src data:; style-src 'unsafe-inline'"

LIMITS = UploadLimits(files=1, total_bytes=1024**3)
_BODY = describe_upload_body(
    "One .npz or .pkl.",
    is_one=True,
    name={"type": "string", "description": "Of the model; the file's when left out."},
    side={"type": "string", "enum": ["right", "left"]},
)


@router.get("/hand-skeleton")
def get_hand_skeleton() -> HandSkeleton:
    """Joints of a hand and how they are connected."""
    fingers = dict.fromkeys(joint.split("_")[0] for joint in HAND_JOINTS if "_" in joint)
    return HandSkeleton(joints=list(HAND_JOINTS), edges=[(a, b) for a, b in HAND_EDGES], fingers=list(fingers))


@router.get("/hand-models")
def list_hand_models(session: SessionDep, cursor: Cursor = None, limit: Limit = 100) -> Page[HandModelOut]:
    """Hand models: first those that come with Handloom, then those that were trained or uploaded, the newest first."""
    rows, next_cursor = service.list_hand_models(session, cursor, limit)
    built_in = storing.list_built_in(session) if cursor is None else []
    return Page(items=[*built_in, *service.describe_hand_models(session, rows)], next_cursor=next_cursor)


@router.get("/hand-models/{model_id}", responses=error_responses(404))
def get_hand_model(model_id: uuid.UUID, session: SessionDep) -> HandModelOut:
    """One hand model."""
    for model in storing.list_built_in(session):
        if model.id == model_id:
            return model
    return service.describe_hand_models(session, [service.get_hand_model(session, model_id)])[0]


@router.get("/hand-models/{model_id}/report", responses=error_responses(404))
def get_hand_model_report(model_id: uuid.UUID, session: SessionDep) -> HandModelReport:
    """What training found: errors, spaces of shape and pose, times."""
    row = service.get_hand_model(session, model_id)
    if row.report is None:
        raise NotFoundError(f"{row.name} was not trained here, so there is no report of its training.")
    return HandModelReport(report=row.report)


@router.get(
    "/hand-models/{model_id}/report.html",
    response_class=Response,
    responses=error_responses(404) | {200: {"content": {"text/html": {}}}},
)
def download_hand_model_report(model_id: uuid.UUID, session: SessionDep) -> Response:
    """The same as one file with its plots, for others: nothing in it is fetched, nothing runs."""
    from tracker.evaluation import write_model_html

    row = service.get_hand_model(session, model_id)
    if row.report is None:
        raise NotFoundError(f"{row.name} was not trained here, so there is no report of its training.")
    facts = {"Round": str(row.round), "Training set": str(row.training_set_id), "SHA-256": row.digest}
    text = write_model_html(row.report, title=row.name, made_at=f"{row.created_at:%Y-%m-%d %H:%M} UTC", facts=facts)
    name = name_download(row.name, "hand-model", row.digest[:12], suffix=".html")
    headers = name | {"Content-Security-Policy": REPORT_POLICY, "Cache-Control": "no-store"}
    return Response(text, media_type="text/html; charset=utf-8", headers=headers)


@router.post(
    "/hand-models",
    status_code=201,
    responses=error_responses(413, 507),
    openapi_extra=_BODY,
    dependencies=[Depends(require_lead)],
)
async def upload_hand_model(
    request: Request, database: DatabaseDep, storage: StorageDep, account_id: AccountIdDep
) -> HandModelOut:
    """Upload a hand model: Handloom's own npz, or MANO's npz or pickle. A pickle is read and never run."""

    def work(folder: Path, upload: Upload) -> HandModelOut:
        path, options = read_one_file(
            folder, upload, "model", HandModelOptions, "a file, and a name and a side where they are known"
        )
        model = storing.read_upload(path, options.side)
        with database.writing() as session:
            row = storing.add_uploaded(session, storage, model, options.name or path.stem, account_id)
            return service.describe_hand_models(session, [row])[0]

    return await work_on_upload(request, storage, "model_uploads", LIMITS, work)


@router.delete("/hand-models/{model_id}", status_code=204, responses=error_responses(404))
def delete_hand_model(model_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> None:
    """Hide a hand model. Nothing of it is lost: `restore` brings it back."""
    service.delete_hand_model(session, service.get_hand_model(session, model_id))
    record_act(session, lead.id, "hand_model.delete", "hand_model", model_id)


@router.post(
    "/hand-models/{model_id}/restore",
    responses=error_responses(404),
    **deprecated("/bin/hand_model/{model_id}/restore"),
)
def restore_hand_model(model_id: uuid.UUID, session: SessionDep, lead: LeadAccount) -> HandModelOut:
    """Undo a deletion."""
    row = service.get_hand_model(session, model_id, deleted_too=True)
    service.restore_hand_model(session, row)
    record_act(session, lead.id, "hand_model.restore", "hand_model", model_id)
    return service.describe_hand_models(session, [row])[0]
