"""`/sequences/{sequence_id}/flags`: labels that look wrong."""

from __future__ import annotations

import uuid
from collections import Counter
from typing import Annotated

from fastapi import APIRouter, Query

from server.accounts.service import CurrentAccount
from server.annotations.guards import GuardsDep, find_hidden
from server.annotations.routes import PlaceDep
from server.annotations.service import Place
from server.database import DatabaseDep, SessionDep
from server.database.paging import Cursor, Limit, read_cursor, write_cursor
from server.errors import error_responses
from server.quality import service
from server.quality.finding import Finding, Kind
from server.quality.schemas import Checked, CheckOut, FlagLook, FlagOut, FlagPage
from server.quality.service import FlagFinderDep
from server.sequences.service import get_sequence

router = APIRouter(prefix="/sequences/{sequence_id}", tags=["quality"], responses=error_responses(404))


@router.get("/flags")
def list_flags(
    sequence_id: uuid.UUID,
    database: DatabaseDep,
    finder: FlagFinderDep,
    account: CurrentAccount,
    guards: GuardsDep,
    kind: Annotated[Kind | None, Query(description="Only these.")] = None,
    dismissed: Annotated[bool, Query(description="Those that were put away instead of the open ones.")] = False,
    cursor: Cursor = None,
    limit: Limit = 100,
) -> FlagPage:
    """Labels that look wrong as they are now, the worst first, and what the checks could look at."""
    with database.reading() as session:
        sequence = get_sequence(session, sequence_id)
        hidden = find_hidden(guards, session, account, sequence_id)
        put_away = service.find_dismissed(session, sequence_id)
        track = service.find_compared(session, sequence_id)
        session.expunge_all()
    found = finder.find(database, sequence_id, sequence.content_key, sequence.hands, track)
    shown = [
        label
        for label in found.labels
        if not any(Place(sequence_id, label.camera, label.frame, label.hand) in places for places in hidden)
    ]
    seen = {label.id for label in shown}
    flags = [flag for flag in found.findings if flag.label.id in seen]
    is_away = {id(flag): (flag.label.id, flag.label.revision, flag.kind) in put_away for flag in flags}
    counts = Counter(flag.kind for flag in flags if not is_away[id(flag)])
    wanted = [flag for flag in flags if is_away[id(flag)] == dismissed and kind in (None, flag.kind)]
    if cursor is not None:
        place = tuple(read_cursor(cursor, int, str, str))
        wanted = [flag for flag in wanted if _order(flag) > place]
    items = wanted[:limit]
    return FlagPage(
        items=[_describe(flag, is_away[id(flag)]) for flag in items],
        next_cursor=write_cursor(*_order(items[-1])) if len(wanted) > limit else None,
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


@router.put("/flags/{camera}/{frame}/{hand}/{kind}/dismissal", status_code=204, responses=error_responses(409))
def dismiss_flag(place: PlaceDep, kind: Kind, body: FlagLook, session: SessionDep, account: CurrentAccount) -> None:
    """The label is right: put the flag away for this revision of it. 409 when the label has changed meanwhile."""
    service.dismiss(session, place, kind, body.revision, account.id)


@router.delete("/flags/{camera}/{frame}/{hand}/{kind}/dismissal", status_code=204)
def restore_flag(
    place: PlaceDep, kind: Kind, session: SessionDep, revision: Annotated[int, Query(ge=1, le=10**9)]
) -> None:
    """Bring a flag back that was put away."""
    service.restore(session, place, kind, revision)


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
