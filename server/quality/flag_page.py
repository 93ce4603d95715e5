"""A page of a recording's flags, made in the process for long computations."""

from __future__ import annotations

import uuid
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from server.access.places import HiddenPlaces, Place
from server.compute import ComputeContext
from server.database.paging import read_cursor, write_cursor
from server.quality import service
from server.quality.finding import Finding, Kind
from server.quality.labels import Label
from server.quality.schemas import Checked, CheckOut, FlagOut, FlagPage
from server.quality.service import FlagFinder
from server.sequences.service import get_sequence


@dataclass(frozen=True)
class FlagQuestion:
    """Which flags of which recording.

    Attributes:
        hidden: Places that whoever asks must not read.
        kind: Only these.
        dismissed: Those that were put away instead of the open ones.
    """

    sequence_id: uuid.UUID
    hidden: Sequence[HiddenPlaces]
    kind: Kind | None
    dismissed: bool
    cursor: str | None
    limit: int


def make_flag_page(context: ComputeContext, asked: FlagQuestion) -> bytes:
    """A `FlagPage` as JSON."""
    with context.database.reading() as session:
        sequence = get_sequence(session, asked.sequence_id)
        put_away = service.find_dismissed(session, asked.sequence_id)
        track = service.find_compared(session, asked.sequence_id)
        session.expunge_all()
    finder = context.keep(FlagFinder)
    found = finder.find(context.database, asked.sequence_id, sequence.content_key, sequence.hands, track)
    shown = [label for label in found.labels if not _is_hidden(label, asked)]
    seen = {label.id for label in shown}
    flags = [flag for flag in found.findings if flag.label.id in seen]
    is_away = {id(flag): (flag.label.id, flag.label.revision, flag.kind) in put_away for flag in flags}
    counts = Counter(flag.kind for flag in flags if not is_away[id(flag)])
    wanted = [flag for flag in flags if is_away[id(flag)] == asked.dismissed and asked.kind in (None, flag.kind)]
    if asked.cursor is not None:
        place = tuple(read_cursor(asked.cursor, int, str, str))
        wanted = [flag for flag in wanted if _order(flag) > place]
    items = wanted[: asked.limit]
    page = FlagPage(
        items=[_describe(flag, is_away[id(flag)]) for flag in items],
        next_cursor=write_cursor(*_order(items[-1])) if len(wanted) > asked.limit else None,
        counts=dict(counts),
        dismissed=sum(is_away.values()),
        checked=Checked(
            labels=len(shown),
            frames=len({label.frame for label in shown}),
            is_behind=found.is_behind,
            track=None if track is None else track.name,
            checks=[
                CheckOut(kind=one.kind, labels=len(one.labels & seen), missing=one.missing) for one in found.coverage
            ],
        ),
    )
    return page.model_dump_json().encode()


def _is_hidden(label: Label, asked: FlagQuestion) -> bool:
    place = Place(asked.sequence_id, label.camera, label.frame, label.hand)
    return any(place in places for places in asked.hidden)


def _order(flag: Finding) -> tuple[int, str, str]:
    return -round(1e6 * flag.score), str(flag.label.id), flag.kind


def _describe(flag: Finding, is_dismissed: bool) -> FlagOut:
    label = flag.label
    return FlagOut.model_validate(
        {
            "kind": flag.kind,
            "score": round(flag.score, 3),
            "reason": flag.reason,
            "camera": label.camera,
            "frame": label.frame,
            "hand": label.hand,
            "joints": list(flag.joints),
            "points": [[float(x), float(y), int(v)] for x, y, v in label.points],
            "revision": label.revision,
            "is_dismissed": is_dismissed,
        }
    )
