"""`/body-models`: the body with hands, posed for the browser and written for other programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Literal

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel

from server.bodies import service
from server.bodies.schemas import BodyExport, BodyModelOut, BodyMotionOut, BodyPoses, Population
from server.download import name_download
from server.errors import error_responses
from server.scans.geometry import MEDIA_TYPE
from server.scans.routes import GEOMETRY
from server.storage import StorageDep
from server.storage.upload import Upload, UploadLimits, work_on_upload
from server.storage.upload_body import describe_upload_body, read_one_file

router = APIRouter(prefix="/body-models", tags=["bodies"], responses=error_responses())

MEDIA = "application/octet-stream"
BINARY: dict[int | str, dict[str, Any]] = {
    200: {"content": {MEDIA: {"schema": {"type": "string", "format": "binary"}}}}
}
LIMITS = UploadLimits(files=1, total_bytes=256 * 1024**2)
MAX_FRAMES = 20_000
"""Frames of a motion that the page takes; the command line has no such limit."""


class NoOptions(BaseModel):
    """The form has a file and nothing else."""


@router.get("/{population}")
def get_body_model(population: Population) -> BodyModelOut:
    """The body with hands that comes with Handloom: SMPL-H's class, one mesh, 52 joints."""
    return service.describe_body(population)


@router.get("/{population}/geometry", response_class=Response, responses=GEOMETRY)
def get_body_geometry(population: Population) -> Response:
    """Vertices of the mean person at rest, and the faces of every pose."""
    return Response(service.pack_body(population), media_type=MEDIA_TYPE, headers={"Cache-Control": "no-cache"})


@router.post("/{population}/poses", response_class=Response, responses=GEOMETRY)
def pose_body(population: Population, body: BodyPoses) -> Response:
    """Vertices of every pose that is asked for, frames x vertices x 3, m. Nothing is stored."""
    return Response(service.pack_poses(population, body), media_type=MEDIA_TYPE)


@router.post("/{population}/export", response_class=Response, responses=BINARY)
def export_body_poses(population: Population, body: BodyExport) -> Response:
    """A pose as OBJ or PLY, or a motion as an animated glTF."""
    headers = name_download(f"{population} body", suffix=f".{body.format}")
    return Response(service.write_poses(population, body), media_type=MEDIA, headers=headers)


@router.get("/{population}/smplh.{kind}", response_class=Response, responses=BINARY)
def download_body_model(population: Population, kind: Literal["npz", "pkl"]) -> Response:
    """The model as a file that `smplx.SMPLH` loads."""
    headers = name_download(f"SMPLH_{population.upper()}", suffix=f".{kind}")
    return Response(service.write_smplh(population, f".{kind}"), media_type=MEDIA, headers=headers)


@router.post(
    "/motions",
    responses=error_responses(413, 507),
    openapi_extra=describe_upload_body("One .npz as AMASS writes motions.", is_one=True),
)
async def read_body_motion(request: Request, storage: StorageDep) -> BodyMotionOut:
    """Read a motion file and give what is in it; nothing is stored."""

    def work(folder: Path, upload: Upload) -> BodyMotionOut:
        path, _ = read_one_file(folder, upload, "motion", NoOptions, "a file")
        return service.read_motion(path, MAX_FRAMES)

    return await work_on_upload(request, storage, "motion_uploads", LIMITS, work)
