"""`/sequences/{sequence_id}/frames-to-look-at`: the hands that most need a person, labelled or not."""

from __future__ import annotations

import uuid

from fastapi import APIRouter

from server.accounts.service import CurrentAccount
from server.annotations.guards import GuardsDep, find_hidden
from server.annotations.service import Place
from server.database import DatabaseDep
from server.database.paging import Cursor, Limit, read_cursor, write_cursor
from server.errors import error_responses
from server.quality import service
from server.quality.doubt import Doubt, doubt_label
from server.quality.find import Setting
from server.quality.queue import Queued, queue_hands
from server.quality.queue_schemas import DoubtOut, HandToLookAt, QueuePage
from server.quality.service import FlagFinderDep
from server.quality.sight import find_sight
from server.sequences.service import get_sequence

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["quality"], responses=error_responses(404))

FAR_PX = 1e5
"""A joint that a track has beside a camera, or behind it, is projected anywhere; so far out no picture shows it."""


@router.get("/frames-to-look-at")
def list_frames_to_look_at(
    sequence_id: uuid.UUID,
    database: DatabaseDep,
    finder: FlagFinderDep,
    account: CurrentAccount,
    guards: GuardsDep,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> QueuePage:
    """Every hand that a track, the hand detector or a label speaks of, the one that most needs a person first."""
    with database.reading() as session:
        sequence = get_sequence(session, sequence_id)
        hidden = find_hidden(guards, session, account, sequence_id)
        put_away = service.find_dismissed(session, sequence_id)
        track = service.find_compared(session, sequence_id)
        session.expunge_all()
    found = finder.find(database, sequence_id, sequence.content_key, sequence.hands, track, with_doubts=True)
    flags = [
        doubt_label(flag) for flag in found.findings if (flag.label.id, flag.label.revision, flag.kind) not in put_away
    ]
    hands = [
        one
        for one in queue_hands([*flags, *found.doubts], found.labels)
        if not any(
            Place(sequence_id, camera, one.frame, one.hand) in places
            for places in hidden
            for camera in found.setting.cameras
        )
    ]
    wanted = hands
    if cursor is not None:
        place = tuple(read_cursor(cursor, int, int, str))
        wanted = [one for one in hands if one.order > place]
    items = wanted[:limit]
    return QueuePage(
        items=[_describe(one, found) for one in items],
        next_cursor=write_cursor(*items[-1].order) if len(wanted) > limit else None,
        hands=len(hands),
        doubtful=sum(one.score >= 1.0 for one in hands),
        track=None if track is None else track.name,
        missing=_say_missing(found.setting),
        is_behind=found.is_behind,
    )


def _say_missing(setting: Setting) -> list[str]:
    """What could not be asked."""
    missing = []
    if not setting.tracked.joints and not setting.tracked.lost:
        missing.append("There is no track: what it would suggest is not looked at.")
    if not setting.detected.frames:
        missing.append("The hand detector has not looked through this recording.")
    if len(setting.cameras) < 2:
        missing.append("This recording has one camera: no other one can disagree.")
    return missing


def _describe(one: Queued, found: service.Flagged) -> HandToLookAt:
    sight = find_sight(one, found.labels, found.setting)
    points = [[x, y, 2] if abs(x) < FAR_PX and abs(y) < FAR_PX else [0.0, 0.0, 0] for x, y in sight.pixels.tolist()]
    return HandToLookAt.model_validate(
        {
            "frame": one.frame,
            "hand": one.hand,
            "score": round(one.score, 3),
            "doubts": [_describe_doubt(doubt) for doubt in one.doubts],
            "camera": sight.camera,
            "points": points,
            "shows": sight.shows,
        }
    )


def _describe_doubt(doubt: Doubt) -> DoubtOut:
    return DoubtOut.model_validate(
        {
            "kind": doubt.kind,
            "score": round(doubt.score, 3),
            "reason": doubt.reason,
            "camera": doubt.camera or None,
            "joints": list(doubt.joints),
            "flag": doubt.flag or None,
        }
    )
