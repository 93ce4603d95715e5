"""A comparison as a file for others."""

from __future__ import annotations

import uuid
from typing import TYPE_CHECKING, Literal

from server.access.models import Account
from server.compute import ComputeContext
from server.errors import InvalidError
from server.evaluations.schemas import Comparison, EvaluationQuery
from server.evaluations.service import compare
from server.storage import Storage
from tracker import say_count

if TYPE_CHECKING:
    from tracker.evaluation import JudgedTrack

MOST_PICTURES = 48
"""In one report; shared out among its tracks."""


def write_report(
    context: ComputeContext, kind: Literal["html", "csv", "json"], query: EvaluationQuery, account: Account
) -> tuple[Comparison, str]:
    """A comparison and its file: a page that needs nothing else, a table of every joint, or the numbers as JSON."""
    from tracker.evaluation import write_csv

    comparison, judged = compare(context, query, account)
    if not judged:
        raise InvalidError("A report needs at least one track: give `track`, `sequence` or `project`.")
    if kind == "html":
        return comparison, write_html_report(context.storage, comparison, judged, query)
    return comparison, write_csv(judged) if kind == "csv" else comparison.model_dump_json(indent=1)


def write_html_report(
    storage: Storage, comparison: Comparison, judged: list[JudgedTrack], query: EvaluationQuery
) -> str:
    """One HTML file with everything in it."""
    from tracker.evaluation import write_html

    return write_html(
        comparison.model_dump(mode="json"),
        _draw_pictures(storage, judged),
        title=_find_title(comparison),
        made_at=comparison.made_at.strftime("%Y-%m-%d %H:%M UTC"),
        about=_say_choice(query),
    )


def _draw_pictures(storage: Storage, judged: list[JudgedTrack]) -> dict[tuple[str, int], bytes]:
    from tracker import load_sequence
    from tracker.evaluation import draw_item, encode_jpeg

    pictures = {}
    each = max(1, min(12, MOST_PICTURES // max(1, len(judged))))
    for one in judged:
        sequence = load_sequence(storage.folder("sequences", uuid.UUID(one.recording_key)))
        for place, item in enumerate(one.evaluation.worst_items(each)):
            pictures[one.key, place] = encode_jpeg(draw_item(sequence, one.evaluation, item))
    return pictures


def _find_title(comparison: Comparison) -> str:
    recordings = list(dict.fromkeys(track.recording for track in comparison.tracks))
    if len(comparison.tracks) == 1:
        return f"{comparison.tracks[0].name} of {recordings[0]}"
    what = recordings[0] if len(recordings) == 1 else say_count(len(recordings), "recording")
    return f"{len(comparison.tracks)} tracks of {what}"


def _say_choice(query: EvaluationQuery) -> str:
    parts = [
        query.camera and f"camera {query.camera}",
        query.hand and f"the {query.hand} hand",
        query.visibility and f"joints marked {query.visibility}",
    ]
    said = ", ".join(part for part in parts if part)
    start = "The frame that a track began at is left out." if query.without_start else ""
    sources = "" if query.source == ["independent"] else f"Joints that count: {', '.join(query.source)}."
    return " ".join(part for part in (said and f"Only {said}.", start, sources) if part)
