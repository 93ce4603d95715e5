"""Bars that other studies measure: the swarm, the detector, starts that are off, hands out of sight."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

from benchmarks.studies import figure_13, robustness, table_08
from benchmarks.studies.bar import Bar, Verdict, at_most, none_of
from benchmarks.studies.study import Extent
from benchmarks.studies.trial import Results
from benchmarks.studies.twin_runs import SEQUENCES

SWARM_SHARE, AUC = 0.5, 0.55
STARTS, RIGHT_SHARE, BACK_FRAMES = 50, 0.8, 5


@dataclass(frozen=True)
class DisturbedStarts:
    """So many starts on a sequence, each off by 15 degrees in every joint and the root and by 10 mm."""

    sequence: str
    starts: int
    made_with: ClassVar = ("twin_runs.py", "robustness.py", "true_pose.py")

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        return {"rows": robustness.perturbed(data, twins, (self.sequence,), self.starts)}


@dataclass(frozen=True)
class HandsGone:
    """Hands of a sequence out of sight for 20 frames, all of them and each."""

    sequence: str
    made_with: ClassVar = ("twin_runs.py", "robustness.py", "blanked.py")

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        return {"rows": robustness.out_of_sight(data, twins, (self.sequence,))}


def list_other_bars(extent: Extent) -> list[Bar]:
    """All of them."""
    return [*_list_robustness_bars(extent), *_list_swarm_bars(extent), _detector_bar(extent)]


def _list_robustness_bars(extent: Extent) -> list[Bar]:
    names = SEQUENCES[2:4] if extent.quick else SEQUENCES
    wanted = len(names) if extent.quick else STARTS
    starts = [
        DisturbedStarts(name, wanted // len(names) + (place < wanted % len(names))) for place, name in enumerate(names)
    ]
    gone = [HandsGone(name) for name in names[:1] if extent.quick] or [HandsGone(name) for name in names]
    group = f"start off by 15 degrees in every joint and the root and by 10 mm ({robustness.TERMS})"
    return [
        Bar(group, f"at least {RIGHT_SHARE:.0%} below 2 px within 10 frames", starts, partial(_right, starts)),
        Bar(group, "the rest reported as lost, never a silent wrong hand", starts, partial(_silent, starts)),
        Bar(
            f"hand out of sight for 20 frames, then back, no annotation ({robustness.TERMS})",
            f"tracked again (within 5 mm) in {BACK_FRAMES} frames, in every sequence",
            gone,
            partial(_back, gone),
        ),
    ]


def _list_swarm_bars(extent: Extent) -> list[Bar]:
    cases = (
        ("40 generations of 64 and 128 particles", ("40 x 64", "40 x 128")),
        ("64 and 128 particles at equal time", table_08.NAMES[-2:]),
    )
    return [
        Bar(
            "particle swarm",
            f"{what}: ours at most half its error",
            table_08.trials(extent),
            partial(_swarm, extent, names),
        )
        for what, names in cases
    ]


def _detector_bar(extent: Extent) -> Bar:
    what = f"AUC at least {AUC} on sequences it was not trained on"
    return Bar("fingertip detector", what, figure_13.trials(extent), partial(_auc, extent))


def _right(starts: Sequence[DisturbedStarts], results: Results) -> Verdict:
    rows = [row for trial in starts for row in results[trial]["rows"]]
    right = sum(row["came_right"] for row in rows)
    share = right / len(rows)
    wrong = ", ".join(f"{row['sequence']} from {row['first']}" for row in rows if not row["came_right"])
    words = f"{right} of {len(rows)}{f'; not: {wrong}' if wrong else ''}"
    return Verdict(words, share >= RIGHT_SHARE, RIGHT_SHARE / max(share, 1e-9))


def _silent(starts: Sequence[DisturbedStarts], results: Results) -> Verdict:
    rows = [row for trial in starts for row in results[trial]["rows"]]
    silent = [row for row in rows if row["is_silent"]]
    where = ", ".join(f"{row['sequence']} from {row['first']}: {row['px'][-1]:.1f} px" for row in silent)
    return none_of(len(silent), f"{len(silent)} silently wrong{f' ({where})' if where else ''}")


def _back(gone: Sequence[HandsGone], results: Results) -> Verdict:
    rows = [row for trial in gone for row in results[trial]["rows"]]
    late = [row for row in rows if row["frames_to_recover"] is None or row["frames_to_recover"] > BACK_FRAMES]
    slowest = max((row["frames_to_recover"] or 0 for row in rows), default=0)
    where = ", ".join(
        f"{row['sequence']} without {' and '.join(row['gone'])}: {row['frames_to_recover'] or 'never'}" for row in late
    )
    words = f"{len(rows) - len(late)} of {len(rows)} cases in time, {where or f'the slowest in {slowest}'}"
    return none_of(len(late), words)


def _swarm(extent: Extent, names: tuple[str, ...], results: Results) -> Verdict:
    rows = table_08.tabulate(results, extent)
    ratio = table_08.worst_ratio(rows, names)
    words = f"{ratio:.3f} of its error in the worst of {len(table_08.CASES)} cases"
    return at_most(ratio, SWARM_SHARE, words)


def _auc(extent: Extent, results: Results) -> Verdict:
    own = figure_13.tabulate(results, extent)[0]
    words = f"{own['auc']:.3f} over {', '.join(own['areas'])}; never trained on any twin"
    return Verdict(words, own["auc"] >= AUC, AUC / own["auc"])
