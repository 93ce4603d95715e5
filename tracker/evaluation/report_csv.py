"""A comparison as a table for other programs: one row for each joint of each annotated hand of each track."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence

import numpy as np

from tracker.capture.source_choice import describe_origin
from tracker.evaluation.comparison import JudgedTrack
from tracker.model.joints import HAND_JOINTS

COLUMNS = (
    *("recording", "track", "track_id", "frame", "camera", "hand", "status", "joint", "visibility"),
    *("marked_x", "marked_y", "tracked_x", "tracked_y", "error_px", "source", "counts"),
)
WORDS = ("absent", "occluded", "visible")


def write_csv(judged: Sequence[JudgedTrack]) -> str:
    """The table; joints marked absent are left out, `error_px` is empty where a joint does not project or count."""
    output = io.StringIO()
    writer = csv.writer(output, lineterminator="\n")
    writer.writerow(COLUMNS)
    for one in judged:
        found = one.evaluation
        names = [defuse(one.recording), defuse(one.name), one.key]
        for item, frame in enumerate(found.frame.tolist()):
            place = [frame, defuse(found.camera[item]), found.hand[item], found.status[item]]
            for joint in np.flatnonzero(found.visibility[item] > 0):
                positions = [*found.marked[item, joint], *found.tracked[item, joint], found.error[item, joint]]
                writer.writerow(
                    [*names, *place, HAND_JOINTS[joint], WORDS[found.visibility[item, joint]]]
                    + [f"{value:.3f}" if np.isfinite(value) else "" for value in positions]
                    + [
                        defuse(describe_origin(found.sources[item], int(joint))),
                        "left out" if found.left_out[item, joint] else "yes",
                    ]
                )
    return output.getvalue()


def defuse(text: str) -> str:
    """A name that no spreadsheet takes for a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text
