"""`/hand-models/{model_id}/...`: a model's mesh for the browser, and its files."""

from __future__ import annotations

import uuid
from typing import Any

from fastapi import APIRouter, Response

from server.database import SessionDep
from server.download import name_download
from server.errors import error_responses
from server.hand_models import storing
from server.hand_models.service import get_hand_model
from server.registrations.model_files import open_any_model, pack_model, write_mano
from server.scans.geometry import MEDIA_TYPE
from server.scans.routes import GEOMETRY, IMMUTABLE
from server.scans.schemas import Side
from server.storage import StorageDep

router = APIRouter(prefix="/hand-models", tags=["hands"], responses=error_responses(404))

BINARY: dict[int | str, dict[str, Any]] = {
    200: {"content": {"application/octet-stream": {"schema": {"type": "string", "format": "binary"}}}}
}


@router.get("/{model_id}/geometry", response_class=Response, responses=GEOMETRY)
def get_hand_model_geometry(model_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> Response:
    """The mesh at rest, its joints, the tips of its fingers and its shape space. It never changes."""
    data = pack_model(open_any_model(session, storage, model_id))
    return Response(data, media_type=MEDIA_TYPE, headers={"Cache-Control": IMMUTABLE})


@router.get("/{model_id}/model.npz", response_class=Response, responses=BINARY)
def download_hand_model(model_id: uuid.UUID, session: SessionDep, storage: StorageDep) -> Response:
    """The model's file, as `handloom register` and the tracker take it."""
    row = get_hand_model(session, model_id)
    data = storing.find_file(storage, row).read_bytes()
    headers = name_download(row.name, "hand-model", row.digest[:12], suffix=".npz") | {"ETag": f'"{row.digest}"'}
    return Response(data, media_type="application/octet-stream", headers=headers)


@router.get("/{model_id}/mano/{side}", response_class=Response, responses=BINARY)
def download_hand_model_as_mano(model_id: uuid.UUID, side: Side, session: SessionDep, storage: StorageDep) -> Response:
    """The model as a MANO file, which `smplx` loads; the other hand is the mirror image."""
    data = write_mano(open_any_model(session, storage, model_id), side)
    name = get_hand_model(session, model_id).name
    headers = name_download(name, f"MANO_{side.upper()}", suffix=".pkl")
    return Response(data, media_type="application/octet-stream", headers=headers)
