"""A page of the queue of hands to look at, made in the process for long computations."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from dataclasses import dataclass

from server.access.places import HiddenPlaces, Place
from server.compute import ComputeContext
from server.database.paging import read_cursor, write_cursor
from server.quality import service
from server.quality.doubt import Doubt, doubt_label
from server.quality.find import Setting
from server.quality.queue import Queued, queue_hands
from server.quality.queue_schemas import DoubtOut, HandToLookAt, QueuePage
from server.quality.service import FlagFinder
from server.quality.sight import find_sight
from server.sequences.service import get_sequence

FAR_PX = 1e5
"""A joint that a track has beside a camera, or behind it, is projected anywhere; so far out no picture shows it."""


@dataclass(frozen=True)
class QueueQuestion:
    """Which part of which recording's queue; `hidden` are places that whoever asks must not read."""

    sequence_id: uuid.UUID
    hidden: Sequence[HiddenPlaces]
    cursor: str | None
    limit: int


def make_queue_page(context: ComputeContext, asked: QueueQuestion) -> bytes:
    """A `QueuePage` as JSON."""
    with context.database.reading() as session:
        sequence = get_sequence(session, asked.sequence_id)
        put_away = service.find_dismissed(session, asked.sequence_id)
        track = service.find_compared(session, asked.sequence_id)
        session.expunge_all()
    finder = context.keep(FlagFinder)
    found = finder.find(
        context.database, asked.sequence_id, sequence.content_key, sequence.hands, track, with_doubts=True
    )
    flags = [
        doubt_label(flag) for flag in found.findings if (flag.label.id, flag.label.revision, flag.kind) not in put_away
    ]
    hands = [
        one
        for one in queue_hands([*flags, *found.doubts], found.labels)
        if not any(
            Place(asked.sequence_id, camera, one.frame, one.hand) in places
            for places in asked.hidden
            for camera in found.setting.cameras
        )
    ]
    wanted = hands
    if asked.cursor is not None:
        place = tuple(read_cursor(asked.cursor, int, int, str))
        wanted = [one for one in hands if one.order > place]
    items = wanted[: asked.limit]
    page = QueuePage(
        items=[_describe(one, found) for one in items],
        next_cursor=write_cursor(*items[-1].order) if len(wanted) > asked.limit else None,
        hands=len(hands),
        doubtful=sum(one.score >= 1.0 for one in hands),
        track=None if track is None else track.name,
        missing=_say_missing(found.setting),
        is_behind=found.is_behind,
    )
    return page.model_dump_json().encode()


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
