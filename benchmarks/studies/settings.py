"""What studies of settings share: the same sequences under one setting, pooled, and how such rows are shown."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from benchmarks.studies.plain_run import PlainRun, pool
from benchmarks.studies.study import SETTING_STEP, Extent, Row
from benchmarks.studies.trial import Results


def runs_of(sequences: Sequence[str], extent: Extent, **setting: Any) -> list[PlainRun]:
    """Algorithm 1 alone with a setting, on each sequence."""
    return [PlainRun(sequence, SETTING_STEP, extent.frames, **setting) for sequence in sequences]


def pooled(results: Results, sequences: Sequence[str], extent: Extent, **setting: Any) -> dict[str, float]:
    """Those runs as one, over all joints of all their frames."""
    return pool([results[run] for run in runs_of(sequences, extent, **setting)])


def show_px(value: float | None) -> str:
    """Two digits, three below one; a dash for what there is none of."""
    if value is None or not math.isfinite(value):
        return "-"
    if value == 0.0:
        return "0"
    return f"{value:.3f}" if abs(value) < 0.9995 else f"{value:.2f}"


def show_lost(row: Row) -> str:
    """Lost frames and collapsed sequences of a pooled row."""
    return f"{row['lost']} in {row['failed']}/{row['sequences']}" if row["lost"] else "0"
