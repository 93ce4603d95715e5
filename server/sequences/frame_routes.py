"""Images of frames: one address each, whose bytes never change."""

from __future__ import annotations

import hashlib
import uuid
from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Query, Request, Response

from server.database.frames import FramePath
from server.errors import InvalidError, error_responses
from server.sequences.depth_colors import Colormap
from server.sequences.frame_images import FrameAddress, FrameImagesDep

router = APIRouter(
    prefix="/sequences/{sequence_id}/{content_key}/cameras/{camera}/frames/{frame}",
    tags=["frames"],
    responses=error_responses(404),
)

IMMUTABLE = "private, max-age=31536000, immutable"
Distance = Annotated[float | None, Query(ge=0, le=1000, allow_inf_nan=False, description="m")]


async def get_address(
    sequence_id: uuid.UUID,
    content_key: Annotated[str, Path(pattern="^[0-9a-f]{32}$", description="`content_key` of the recording.")],
    camera: Annotated[str, Path(max_length=64)],
    frame: FramePath,
) -> FrameAddress:
    """The frame that the address names."""
    return FrameAddress(sequence_id, content_key, camera, frame)


AddressDep = Annotated[FrameAddress, Depends(get_address)]


def _image(kind: str) -> dict[int | str, dict[str, Any]]:
    content = {kind: {"schema": {"type": "string", "format": "binary"}}}
    return {200: {"content": content, "description": "The image."}, 304: {"description": "You have it already."}}


def _answer(request: Request, media_type: str, make: Callable[[], tuple[bytes, dict[str, str]]]) -> Response:
    """The image, or only that it is still the same: the address holds the content key, so a tag needs nothing else."""
    tag = hashlib.sha256(f"{request.url.path}?{request.url.query}".encode()).hexdigest()[:24]
    headers = {"Cache-Control": IMMUTABLE, "ETag": f'"{tag}"'}
    known = [name.strip().removeprefix("W/") for name in request.headers.get("if-none-match", "").split(",")]
    if headers["ETag"] in known:
        return Response(status_code=304, headers=headers)
    data, more = make()
    return Response(data, media_type=media_type, headers=headers | more)


@router.get("/color.jpg", response_class=Response, responses=_image("image/jpeg"))
def get_color_image(at: AddressDep, images: FrameImagesDep, request: Request) -> Response:
    """The colour image of a frame."""
    return _answer(request, "image/jpeg", lambda: (images.color_jpeg(at), {}))


@router.get("/depth.png", response_class=Response, responses=_image("image/png"))
def get_depth_image(
    at: AddressDep,
    images: FrameImagesDep,
    request: Request,
    colormap: Colormap = "turbo",
    near: Distance = None,
    far: Distance = None,
) -> Response:
    """Depth in colours: near is bright, far is dark, no value is transparent."""
    if near is not None and far is not None and far <= near:
        raise InvalidError(f"far is {far} m and near {near} m; far must be more.")
    return _answer(request, "image/png", lambda: (images.depth_png(at, colormap, near, far), {}))


@router.get("/depth.bin", response_class=Response, responses=_image("application/octet-stream"))
def get_depth_values(at: AddressDep, images: FrameImagesDep, request: Request) -> Response:
    """Raw depth: little-endian uint16, row by row; `X-Width`, `X-Height` in px, `X-Depth-Scale` in m per unit."""

    def make() -> tuple[bytes, dict[str, str]]:
        raw, scale = images.depth_raw(at)
        size = {"X-Width": str(raw.shape[1]), "X-Height": str(raw.shape[0]), "X-Depth-Scale": repr(float(scale))}
        return raw.astype("<u2", copy=False).tobytes(), size

    return _answer(request, "application/octet-stream", make)


@router.get("/thumbnail.jpg", response_class=Response, responses=_image("image/jpeg"))
def get_thumbnail(at: AddressDep, images: FrameImagesDep, request: Request) -> Response:
    """A small picture of a frame."""
    return _answer(request, "image/jpeg", lambda: (images.thumbnail_jpeg(at), {}))
