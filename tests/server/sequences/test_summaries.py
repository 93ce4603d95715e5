"""What other rooms know of recordings goes with them, asked for once for all of them."""

from __future__ import annotations

import uuid
from collections.abc import Sequence
from typing import Any

from server.sequences.models import SequenceRow
from server.sequences.summaries import describe_sequences
from tests.server.sequences.stored import Shelf


def test_what_rooms_know_is_merged_and_each_is_asked_once(shelf: Shelf, make_recording) -> None:
    rows = [shelf.put(make_recording(name)) for name in ("one", "two")]
    asked: list[list[uuid.UUID]] = []

    def count(_: Any, ids: Sequence[uuid.UUID]) -> dict[uuid.UUID, dict[str, Any]]:
        asked.append(list(ids))
        return {rows[1].id: {"annotated_frames": 3, "done_frames": 1}}

    best = {"id": uuid.uuid4(), "summary": {"lost": 0}, "error_px": None}
    with shelf.database.reading() as session:
        held = [session.get_one(SequenceRow, row.id) for row in rows]
        told = describe_sequences(session, held, [count, lambda *_: {rows[1].id: {"best_track": best}}])
        assert describe_sequences(session, [], [count]) == []
    assert asked == [[row.id for row in rows]], "nobody is asked about nothing"
    assert [(one.name, one.annotated_frames, one.done_frames) for one in told] == [("one", 0, 0), ("two", 3, 1)]
    assert told[0].best_track is None and told[1].best_track is not None and told[1].best_track.id == best["id"]
