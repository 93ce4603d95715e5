"""Bars that other studies measure: the swarm, the detector, our own hand, disturbed starts, displacement."""

from __future__ import annotations

from functools import partial

from benchmarks.studies import figure_13, table_08
from benchmarks.studies.bar import Bar, Verdict, at_most
from benchmarks.studies.study import Extent
from benchmarks.studies.trial import Results

SWARM_SHARE, AUC = 0.5, 0.55


def list_other_bars(extent: Extent) -> list[Bar]:
    """All of them."""
    return [
        *_list_swarm_bars(extent),
        Bar(
            "fingertip detector",
            f"AUC at least {AUC} on sequences it was not trained on",
            figure_13.trials(extent),
            partial(_auc, extent),
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


def _swarm(extent: Extent, names: tuple[str, ...], results: Results) -> Verdict:
    rows = table_08.tabulate(results, extent)
    ratio = table_08.worst_ratio(rows, names)
    words = f"{ratio:.3f} of its error in the worst of {len(table_08.CASES)} cases"
    return at_most(ratio, SWARM_SHARE, words)


def _auc(extent: Extent, results: Results) -> Verdict:
    own = figure_13.tabulate(results, extent)[0]
    words = f"{own['auc']:.3f} over {', '.join(own['areas'])}; never trained on any twin"
    return Verdict(words, own["auc"] >= AUC, AUC / own["auc"])
