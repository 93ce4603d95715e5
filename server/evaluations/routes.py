"""`/evaluations`, and a track's own evaluation."""

from __future__ import annotations

import hashlib
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Path, Query, Request, Response

from server.access.service import CurrentAccount
from server.annotations.schemas import SOURCES_HELP, SourceChoice
from server.database import DatabaseDep
from server.database.frames import FramePath
from server.download import name_download
from server.errors import InvalidError, error_responses
from server.evaluations import service
from server.evaluations.judge import JudgeDep
from server.evaluations.reports import write_html_report
from server.evaluations.schemas import Comparison, EvaluationQuery, Hand
from server.storage import StorageDep
from server.tracks.seen_track import SeenTrack

router = APIRouter(tags=["evaluations"], responses=error_responses(404))

QueryDep = Annotated[EvaluationQuery, Query()]
SourceQuery = Annotated[list[SourceChoice], Query(min_length=1, max_length=10, description=SOURCES_HELP)]
JUDGING: list[SourceChoice] = ["independent"]


IMMUTABLE = "private, max-age=31536000, immutable"
MEDIA_TYPES = {"html": "text/html; charset=utf-8", "csv": "text/csv; charset=utf-8", "json": "application/json"}
REPORT_POLICY = "sandbox; default-src 'none'; img-src data:; style-src 'unsafe-inline'"


@router.get("/tracks/{track_id}/evaluation")
def get_track_evaluation(
    track: SeenTrack, database: DatabaseDep, judge: JudgeDep, source: SourceQuery = JUDGING
) -> dict[str, Any]:
    """Errors of a track against the annotations as they are now, px, for each joint and frame.

    Joints that a track had a part in do not count unless `source` asks for them; `sources` says how many that are.
    """
    return service.evaluate(database, judge, track, source)


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
    database: DatabaseDep,
    storage: StorageDep,
    judge: JudgeDep,
    source: SourceQuery = JUDGING,
) -> Response:
    """An annotated hand cut out of its image: what was marked, and where the track has it."""
    tag = f'"{hashlib.sha256(f"{request.url.path}?{request.url.query}".encode()).hexdigest()[:24]}"'
    headers = {"Cache-Control": IMMUTABLE, "ETag": tag}
    if tag in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=headers)
    data = service.draw_picture(database, storage, judge, track, labels, (camera, frame, hand), source)
    return Response(data, media_type="image/jpeg", headers=headers)


@router.get("/evaluations")
def compare_tracks(query: QueryDep, database: DatabaseDep, judge: JudgeDep, account: CurrentAccount) -> Comparison:
    """Tracks judged by annotations, side by side: tables, curves, worst frames, differences against one of them."""
    return service.compare(database, judge, query, account)[0]


@router.get(
    "/evaluations/report.{kind}",
    response_class=Response,
    responses={200: {"content": {kind.partition(";")[0]: {} for kind in MEDIA_TYPES.values()}}},
)
def get_report(
    kind: Literal["html", "csv", "json"],
    query: QueryDep,
    database: DatabaseDep,
    storage: StorageDep,
    judge: JudgeDep,
    account: CurrentAccount,
) -> Response:
    """The same as a file: a page that needs nothing else, a table of every joint, or the numbers as JSON."""
    from tracker.evaluation import write_csv

    comparison, judged = service.compare(database, judge, query, account)
    if not judged:
        raise InvalidError("A report needs at least one track: give `track`, `sequence` or `project`.")
    if kind == "html":
        text = write_html_report(storage, comparison, judged, query)
    elif kind == "csv":
        text = write_csv(judged)
    else:
        text = comparison.model_dump_json(indent=1)
    recordings = list(dict.fromkeys(track.recording for track in comparison.tracks))
    others = [f"and {len(recordings) - 1} more"] if len(recordings) > 1 else []
    what = f"evaluation-{comparison.made_at:%Y%m%d-%H%M}"
    name = name_download(*recordings[:1], *others, what, suffix=f".{kind}")
    headers = name | {"Content-Security-Policy": REPORT_POLICY, "Cache-Control": "no-store"}
    return Response(text, media_type=MEDIA_TYPES[kind], headers=headers)
