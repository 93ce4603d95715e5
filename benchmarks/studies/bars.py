"""Every bar of the project, measured: met or not."""

from __future__ import annotations

import math

from benchmarks.studies.bar import Bar
from benchmarks.studies.bars_accuracy import list_accuracy_bars, list_term_bars
from benchmarks.studies.bars_cost import list_cost_bars
from benchmarks.studies.bars_elsewhere import list_other_bars
from benchmarks.studies.bars_held import list_held_bars
from benchmarks.studies.bars_own_hand import list_own_hand_bars
from benchmarks.studies.blocks import Block, Picture, Table, Text
from benchmarks.studies.ratio_plot import draw_ratios
from benchmarks.studies.study import Extent, Row, Study
from benchmarks.studies.trial import Results, Trial


def list_bars(extent: Extent) -> list[Bar]:
    """All bars, in the order of the project's table."""
    return [
        *list_accuracy_bars(extent),
        *list_own_hand_bars(extent),
        *list_other_bars(extent),
        *list_term_bars(extent),
        *list_held_bars(extent),
        *list_cost_bars(extent),
    ]


def trials(extent: Extent) -> list[Trial]:
    return [trial for bar in list_bars(extent) for trial in bar.trials]


def tabulate(results: Results, extent: Extent) -> list[Row]:
    return [bar.row(results) for bar in list_bars(extent)]


def show_verdict(row: Row) -> str:
    """In a word."""
    return {True: "met", False: "**not met**", None: "not measured"}[row["is_met"]]


def show(rows: list[Row]) -> list[Block]:
    count = {verdict: sum(row["is_met"] is verdict for row in rows) for verdict in (True, False, None)}
    missing = f", {count[None]} not measured" if count[None] else ""
    blocks: list[Block] = [
        Text(f"**{count[True]} of {len(rows)} met**, {count[False]} not met{missing}."),
    ]
    items = [
        (f"{row['group'].split(' (')[0]}: {row['what']}", row["ratio"]) for row in rows if row["ratio"] is not None
    ]
    if items:
        drawn = draw_ratios(items, "Each bar's measured value as a share of what is allowed")
        blocks.append(
            Picture("bars", drawn, "Measured, of what each bar allows; those that are not numbers are below.")
        )
    for group in dict.fromkeys(row["group"] for row in rows):
        own = [row for row in rows if row["group"] == group]
        notes = " ".join(dict.fromkeys(row["note"] for row in own if row["note"]))
        cells = tuple((row["what"], row["measured"], _of_bar(row), show_verdict(row)) for row in own)
        blocks.append(Table((group, "measured", "of the bar", ""), cells, notes))
    return blocks


def _of_bar(row: Row) -> str:
    ratio = row["ratio"]
    return "" if ratio is None or not math.isfinite(ratio) else f"{100.0 * ratio:.0f} %"


STUDY = Study(
    name="bars",
    title="What it must show",
    paper="Bars, the project's own",
    question="Is every bar met?",
    same="Nothing here is the paper's. Twins of its eight public sequences, whole, with sensor noise, started from the "
    "annotation of the first frame, ten iterations; a hand is lost in a frame when its mean joint error exceeds 40 mm.",
    differs="Pixels of twins are not T16's 5.12 px on its recordings, where the model's own error dominates.",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
