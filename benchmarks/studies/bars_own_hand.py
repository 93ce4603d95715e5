"""Bars on our own hand, calibrated from the first seconds: a wrong model, as in real life."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial

from benchmarks.studies.bar import Bar, Verdict, at_most, none_of
from benchmarks.studies.bars_accuracy import DEFAULT, own_hand_sequences, run_of, show_each
from benchmarks.studies.study import Extent
from benchmarks.studies.trial import Results
from benchmarks.studies.twin_runs import Run

MEAN_PX, MEAN_MM = 2.5, 4.0
NOTE = "Calibration was developed on 09 and 15; the other six say how it does elsewhere (own_hand.py, by joint)."


def list_own_hand_bars(extent: Extent) -> list[Bar]:
    """All of them."""
    bars = []
    for step, which in ((1, "every frame"), (3, "every 3rd frame")):
        runs = [run_of(name, step, extent, own=True) for name in own_hand_sequences(extent)]
        group = f"our own hand, calibrated, {which} ({DEFAULT})"
        bars += [
            Bar(group, f"mean at most {MEAN_PX} px", runs, partial(_judge_mean, runs, "px", MEAN_PX)),
            Bar(group, f"mean at most {MEAN_MM:.0f} mm", runs, partial(_judge_mean, runs, "mm", MEAN_MM)),
            Bar(group, "none lost", runs, partial(_judge_lost, runs)),
        ]
    return bars


def _judge_mean(runs: Sequence[Run], unit: str, limit: float, results: Results) -> Verdict:
    """Of each sequence: the worst counts."""
    means = [results[run][unit] for run in runs]
    return at_most(max(means), limit, show_each(runs, means, unit), NOTE)


def _judge_lost(runs: Sequence[Run], results: Results) -> Verdict:
    lost = {run.sequence: results[run]["lost"] for run in runs}
    frames = sum(results[run]["frames"] for run in runs)
    where = ", ".join(f"{name}: {count}" for name, count in lost.items() if count)
    count = sum(lost.values())
    return none_of(count, f"{count} of {frames} frames{f' ({where})' if count else ''}")
