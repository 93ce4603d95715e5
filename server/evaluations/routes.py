"""`/evaluations`, and a track's own evaluation."""

from __future__ import annotations

import hashlib
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query, Request, Response

from server.access.service import CurrentAccount
from server.annotations.schemas import SOURCES_HELP, SourceChoice
from server.compute import ComputeDep
from server.database.frames import FramePath
from server.download import name_download
from server.errors import error_responses
from server.evaluations import service
from server.evaluations.reports import write_report
from server.evaluations.schemas import Comparison, EvaluationQuery, Hand
from server.tracks.seen_track import SeenTrack

router = APIRouter(tags=["evaluations"], responses=error_responses(404))

QueryDep = Annotated[EvaluationQuery, Query()]
SourceQuery = Annotated[list[SourceChoice], Query(min_length=1, max_length=10, description=SOURCES_HELP)]
JUDGING: list[SourceChoice] = ["independent"]
IMMUTABLE = "private, max-age=31536000, immutable"
MEDIA_TYPES = {"html": "text/html; charset=utf-8", "csv": "text/csv; charset=utf-8", "json": "application/json"}
REPORT_POLICY = "sandbox; default-src 'none'; img-src data:; style-src 'unsafe-inline'"


@router.get("/tracks/{track_id}/evaluation")
def get_track_evaluation(track: SeenTrack, compute: ComputeDep, source: SourceQuery = JUDGING) -> dict[str, Any]:
    """Errors of a track against the annotations as they are now, px, for each joint and frame.

    Joints that a track had a part in do not count unless `source` asks for them; `sources` says how many that are.
    """
    return compute.ask(service.evaluate, track, source)


@router.get(
    "/tracks/{track_id}/evaluation/{labels}/{camera}/{frame}/{hand}.jpg",
    response_class=Response,
    responses={
        200: {"content": {"image/jpeg": {"schema": {"type": "string", "format": "binary"}}}},
        304: {"description": "You have it already."},
    },
)
def get_evaluation_picture(
    track: SeenTrack,
    labels: Annotated[str, Path(pattern="^(now-[0-9]{1,15}|snapshot-[0-9a-f]{8}(-[0-9a-f]{4}){3}-[0-9a-f]{12})$")],
    camera: Annotated[str, Path(max_length=64)],
    frame: FramePath,
    hand: Hand,
    request: Request,
    compute: ComputeDep,
    source: SourceQuery = JUDGING,
) -> Response:
    """An annotated hand cut out of its image: what was marked, and where the track has it."""
    tag = f'"{hashlib.sha256(f"{request.url.path}?{request.url.query}".encode()).hexdigest()[:24]}"'
    headers = {"Cache-Control": IMMUTABLE, "ETag": tag}
    if tag in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=headers)
    data = compute.ask(service.draw_picture, track, labels, (camera, frame, hand), source)
    return Response(data, media_type="image/jpeg", headers=headers)


@router.get("/evaluations")
def compare_tracks(query: QueryDep, compute: ComputeDep, account: CurrentAccount) -> Comparison:
    """Tracks judged by annotations, side by side: tables, curves, worst frames, differences against one of them."""
    return compute.ask(service.describe_comparison, query, account)


@router.get(
    "/evaluations/report.{kind}",
    response_class=Response,
    responses={200: {"content": {kind.partition(";")[0]: {} for kind in MEDIA_TYPES.values()}}},
)
def get_report(
    kind: Literal["html", "csv", "json"],
    query: QueryDep,
    compute: ComputeDep,
    account: CurrentAccount,
) -> Response:
    """The same as a file: a page that needs nothing else, a table of every joint, or the numbers as JSON."""
    comparison, text = compute.ask(write_report, kind, query, account)
    recordings = list(dict.fromkeys(track.recording for track in comparison.tracks))
    others = [f"and {len(recordings) - 1} more"] if len(recordings) > 1 else []
    what = f"evaluation-{comparison.made_at:%Y%m%d-%H%M}"
    name = name_download(*recordings[:1], *others, what, suffix=f".{kind}")
    headers = name | {"Content-Security-Policy": REPORT_POLICY, "Cache-Control": "no-store"}
    return Response(text, media_type=MEDIA_TYPES[kind], headers=headers)
