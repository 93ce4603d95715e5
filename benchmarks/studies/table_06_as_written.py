"""[T16] Tables 6 and 13 with the paper's method as written, on the authors' full meshes."""

from __future__ import annotations

from benchmarks.studies import paper
from benchmarks.studies.as_written import AsWritten, compare
from benchmarks.studies.blocks import Block, Table, Text
from benchmarks.studies.plain_run import pool
from benchmarks.studies.settings import show_px
from benchmarks.studies.study import HAND_HAND, Extent, Row, Study
from benchmarks.studies.trial import Results, Trial

BAR_PX = 1.0
HELD = ("15", "20")
PARTS = (("LO m2d", "LO", "m2d"), ("LO d2m", "LO", "d2m"))
"""The paper's name, terms, data terms."""
HANDS = ("LO", "LO+C", "LO+S", "LO+SC")
OBJECTS = ("LO", "LO+C", "LO+S", "LO+SC", "LO+CP", "LO+SCP")
PAIRS = (
    ("orientation of edges", HAND_HAND, "LO+SC", "LO+SC, any edge"),
    ("vertices, not pixels", HAND_HAND, "LO+SC", "LO+SC, every pixel"),
    ("C", HAND_HAND, "LO+C", "LO"),
    ("C beside S", HAND_HAND, "LO+SC", "LO+S"),
    ("S", HAND_HAND, "LO+S", "LO"),
    ("S beside C", HAND_HAND, "LO+SC", "LO+C"),
    ("C", HELD, "LO+C", "LO"),
    ("S beside C", HELD, "LO+SC", "LO+C"),
    ("P beside C", HELD, "LO+CP", "LO+C"),
    ("P beside SC", HELD, "LO+SCP", "LO+SC"),
)
"""Term, sequences, with it, without it: the terms, and behind a comma which of the `DATA` of as_written.py."""


def _pair(sequences: tuple[str, ...], extent: Extent, what: str) -> list[AsWritten]:
    terms, _, data = what.partition(", ")
    return _runs(sequences, extent, terms, data or "both")


def _runs(sequences: tuple[str, ...], extent: Extent, terms: str, data: str = "both") -> list[AsWritten]:
    return [AsWritten(name, terms, data=data, frames=extent.frames) for name in sequences]


def trials(extent: Extent) -> list[Trial]:
    """The bar's own set first."""
    found: list[Trial] = [run for terms in reversed(HANDS) for run in _runs(HAND_HAND, extent, terms)]
    found += [run for _, terms, data in PARTS for run in _runs(HAND_HAND, extent, terms, data)]
    found += [run for terms in OBJECTS for run in _runs(HELD, extent, terms)]
    return found + [run for _, names, *both in PAIRS for what in both for run in _pair(names, extent, what)]


def tabulate(results: Results, extent: Extent) -> list[Row]:
    rows: list[Row] = []
    for name, terms, data in (*PARTS, *((terms, terms, "both") for terms in HANDS)):
        runs = [results[run] for run in _runs(HAND_HAND, extent, terms, data)]
        each = {sequence: run["px"] for sequence, run in zip(HAND_HAND, runs, strict=True)}
        median_ms = max(run["median_ms"] for run in runs)
        rows.append({"kind": "hands", "paper": name, "each": each, "slowest_ms": median_ms, **pool(runs)})
    for terms in OBJECTS:
        runs = [results[run] for run in _runs(HELD, extent, terms)]
        each = {sequence: run["px"] for sequence, run in zip(HELD, runs, strict=True)}
        rows.append(
            {
                "kind": "objects",
                "paper": terms,
                "each": each,
                "slowest_ms": max(run["median_ms"] for run in runs),
                "object_mm": [next(iter(run["objects"].values()))["mm"] for run in runs],
                **pool(runs),
            }
        )
    for term, sequences, with_it, without in PAIRS:
        pairs = [[results[run] for run in _pair(sequences, extent, what)] for what in (with_it, without)]
        mean, low, high = compare(*pairs)
        rows.append(
            {
                "kind": "pair",
                "term": term,
                "sequences": list(sequences),
                "with": with_it,
                "without": without,
                "px": mean,
                "low": low,
                "high": high,
            }
        )
    return rows


FIGURES = ("mean px", "mean mm", "worst frame mm", "deepest mm", "failed")


def show(rows: list[Row]) -> list[Block]:
    hands = [row for row in rows if row["kind"] == "hands"]
    objects = [row for row in rows if row["kind"] == "objects"]
    whole = next(row for row in hands if row["paper"] == "LO+SC")
    is_met = whole["px"] <= BAR_PX and whole["failed"] == 0
    bar = (
        f"**Bar: at most {BAR_PX} px pooled, none of the four failed: {show_px(whole['px'])} px, {whole['failed']} of "
        f"{whole['sequences']} failed ({'met' if is_met else 'not met'}).** The preset has P too, which does nothing "
        "without an object. The same mesh is rendered and tracked, so that only noise and the optimiser can be wrong: "
        "T16's 5 px hold the misfit of a scanned hand and of manual marks as well."
    )
    pairs = tuple(
        (
            row["term"],
            ", ".join(row["sequences"]),
            f"{row['with']} against {row['without']}",
            f"{row['px']:+.3f}",
            f"{row['low']:+.3f} to {row['high']:+.3f}",
            _say(row),
        )
        for row in rows
        if row["kind"] == "pair"
    )
    return [
        Text(bar),
        Table(
            (
                "objective",
                *HAND_HAND,
                "mean px",
                "mean mm",
                "worst frame mm",
                "deepest mm",
                "failed",
                "T16 mean px",
                "T16 failed",
            ),
            tuple((row["paper"], *_cells(row, HAND_HAND), *paper.TABLE_6[row["paper"]]) for row in hands),
            "Mean px of each sequence, then of all; a sequence failed where a hand was ever more than 40 mm off. T16 "
            "averages over the sequences that did not fail, these rows over all.",
        ),
        Table(
            (
                "objective",
                *HELD,
                "mean px",
                "mean mm",
                "worst frame mm",
                "deepest mm",
                "failed",
                "ball, cube mm",
                "T16 mean px",
            ),
            tuple(
                (
                    row["paper"],
                    *_cells(row, HELD),
                    ", ".join(f"{mm:.2f}" for mm in row["object_mm"]),
                    show_px(paper.TABLE_13[row["paper"]][0]),
                )
                for row in objects
            ),
            "Hand and ball, hand and cube: two of the seven sequences of T16's Table 13.",
        ),
        Table(
            ("term", "sequences", "pair", "difference px", "95 % interval", "the term"),
            pairs,
            "Paired by frames; the interval is a bootstrap over blocks of ten frames.",
        ),
    ]


def _cells(row: Row, sequences: tuple[str, ...]) -> tuple[str, ...]:
    figures = (row["px"], row["mm"], row["worst_mm"], row["deepest_mm"])
    each = tuple(show_px(row["each"][name]) for name in sequences)
    return (*each, *(show_px(value) for value in figures), f"{row['failed']}/{row['sequences']}")


def _say(row: Row) -> str:
    if row["high"] < 0.0:
        return "helps"
    return "harms" if row["low"] > 0.0 else "no difference shown"


STUDY = Study(
    name="table_06_as_written",
    title="Components, the paper's method as written",
    paper="Tables 6 and 13, §4.1.4 and §4.2.2",
    question="What do the paper's terms give on full meshes, with all matches, oriented edges and its weights?",
    same="Eq. 5 with its weights (γ_c = 10, γ_ph = 10, λ = 1.2), ten iterations, S and P in every one, the authors' "
    "meshes of 20,000 faces.",
    differs="Six of eighteen sequences, every third frame (three times the motion), so that roots are predicted; cones "
    "and detector are ours (docs/objective.md).",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
