"""Compares tracks with labels, and with each other."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any
from urllib.parse import quote, urlencode

from server.access.models import Account
from server.access.policy import check_sees_tracks
from server.compute import ComputeContext
from server.database import utc_now
from server.errors import NotFoundError
from server.evaluations.choice import Chosen, choose_tracks
from server.evaluations.judge import Judge
from server.evaluations.labels import LabelsId, find_current_labels, find_snapshots
from server.evaluations.schemas import Comparison, EvaluationQuery
from server.tracks.models import TrackRow

if TYPE_CHECKING:
    from tracker.evaluation import JudgedTrack

VISIBILITIES = {"occluded": 1, "visible": 2}


def evaluate(context: ComputeContext, row: TrackRow, source: Sequence[str]) -> dict[str, Any]:
    """Evaluate a track against the annotations of its recording.

    Its mean error by joints that no track had a part in is kept with its row.
    """
    from tracker.capture import JUDGING

    with context.database.reading() as session:
        labels = find_current_labels(session, row.sequence_id)
    evaluation = context.keep(Judge).find(context.database, row.id, labels).evaluation
    error_px = evaluation.select(sources=JUDGING).statistics.mean
    if error_px != row.error_px:
        with context.database.writing() as session:
            track = session.get(TrackRow, row.id)
            assert track is not None
            track.error_px = error_px
    return evaluation.select(sources=source).to_json()


def compare(context: ComputeContext, query: EvaluationQuery, account: Account) -> tuple[Comparison, list[JudgedTrack]]:
    """The comparison that was asked for, and the tracks in it; raises at a recording that the account must not see."""
    from tracker.evaluation import compare_tracks

    with context.database.reading() as session:
        chosen = choose_tracks(session, query)
        for sequence_id in dict.fromkeys(one.sequence.id for one in chosen):
            check_sees_tracks(session, account, sequence_id)
    judged = [_judge(context, one, query) for one in chosen]
    reference = query.reference or next((one.track.id for one in chosen), None)
    document = compare_tracks(judged, reference=None if reference is None else str(reference), within_px=query.within)
    for one, described in zip(chosen, document["tracks"], strict=True):
        for item in described["worst"]:
            item["picture"] = write_picture_address(one, item["camera"], item["frame"], item["hand"], query.source)
    cameras = dict.fromkeys(camera["id"] for one in chosen for camera in one.sequence.cameras)
    more = {"made_at": utc_now(), "cameras": list(cameras), "source": query.source}
    return Comparison.model_validate(document | more), judged


def describe_comparison(context: ComputeContext, query: EvaluationQuery, account: Account) -> Comparison:
    """The comparison alone, as the page shows it."""
    return compare(context, query, account)[0]


def _judge(context: ComputeContext, one: Chosen, query: EvaluationQuery) -> JudgedTrack:
    from tracker.evaluation import JudgedTrack

    verdict = context.keep(Judge).find(context.database, one.track.id, one.labels)
    return JudgedTrack(
        key=str(one.track.id),
        name=one.track.name,
        recording_key=str(one.sequence.id),
        recording=one.sequence.name,
        parameters=verdict.parameters,
        evaluation=verdict.evaluation.select(
            camera=query.camera,
            hand=query.hand or "",
            visibility=None if query.visibility is None else VISIBILITIES[query.visibility],
            without_start=query.without_start,
            sources=query.source,
        ),
        labels=verdict.labels,
        origin={
            "id": str(one.track.id),
            "sha256": verdict.track_sha256,
            "made_at": one.track.created_at.isoformat(timespec="seconds"),
            "job_id": None if one.track.job_id is None else str(one.track.job_id),
        },
    )


def write_picture_address(one: Chosen, camera: str, frame: int, hand: str, source: Sequence[str]) -> str:
    """Where the picture of an item is; the address names the labels, so what it shows never changes."""
    from tracker.capture import JUDGING

    place = f"{quote(camera, safe='')}/{frame}/{hand}.jpg"
    chosen = "" if tuple(source) == JUDGING else "?" + urlencode({"source": source}, doseq=True)
    return f"/api/v1/tracks/{one.track.id}/evaluation/{one.labels.key}/{place}{chosen}"


def draw_picture(
    context: ComputeContext,
    track: TrackRow,
    labels_key: str,
    place: tuple[str, int, str],
    source: Sequence[str],
) -> bytes:
    """The picture of one hand in one image: marks and track, cut out."""
    from tracker import load_sequence
    from tracker.evaluation import draw_item, encode_jpeg

    with context.database.reading() as session:
        labels = _find_labels(session, track.sequence_id, labels_key)
    found = context.keep(Judge).find(context.database, track.id, labels)
    evaluation = found.evaluation.select(sources=source)
    camera, frame, hand = place
    keys = zip(evaluation.camera, evaluation.frame.tolist(), evaluation.hand, strict=True)
    item = next((number for number, key in enumerate(keys) if key == place), None)
    if item is None:
        raise NotFoundError(f"The {hand} hand in frame {frame} of {camera} is not both annotated and tracked.")
    return encode_jpeg(
        draw_item(load_sequence(context.storage.folder("sequences", track.sequence_id)), evaluation, item)
    )


def _find_labels(session: Any, sequence_id: uuid.UUID, key: str) -> LabelsId:
    kind, _, id_ = key.partition("-")
    if kind == "snapshot":
        labels = find_snapshots(session, [uuid.UUID(id_)]).get(sequence_id)
        if labels is None:
            raise NotFoundError(f"The snapshot {id_} is not of this track's recording.")
        return labels
    labels = find_current_labels(session, sequence_id)
    if labels.key != key:
        raise NotFoundError(
            f"The labels are at revision {labels.revision} now; pictures of revision {id_} are no longer made. "
            "Load the evaluation again, or judge by a snapshot."
        )
    return labels
