"""[T16] Tables 7 and 14: the tracker as it comes, sequence by sequence."""

from __future__ import annotations

from collections.abc import Sequence

from benchmarks.studies import paper
from benchmarks.studies.blocks import Block, Picture, Table
from benchmarks.studies.plots import Bars, draw_plot
from benchmarks.studies.settings import show_px
from benchmarks.studies.study import HAND_HAND, HAND_OBJECT, TITLES, Extent, Row, Study
from benchmarks.studies.trial import Results
from benchmarks.studies.twin_runs import Run

SAME = "The same motions, every frame, the same terms; error over all joints of all frames."
DIFFERS = (
    "Pixels: the twin is rendered with the tracked model and the truth is exact, while the paper's pixels hold the "
    "model's misfit and its annotators' 1.5 px. {} T16's joints are those of its Fig. 12, ours the 21 of a hand."
)


def _runs(names: Sequence[str], terms: str, extent: Extent) -> list[Run]:
    return [Run(name, 1, extent.frames, terms, penetration=True) for name in names]


def _tabulate(results: Results, names: Sequence[str], terms: str, extent: Extent) -> list[Row]:
    kept = (
        "frames",
        "moving_frames",
        "px",
        "moving_px",
        "px_std",
        "px_max",
        "mm",
        "worst_mm",
        "lost",
        "median_ms",
        "objects",
    )
    return [
        {"sequence": run.sequence, **{key: results[run][key] for key in kept}} for run in _runs(names, terms, extent)
    ]


def _plot(rows: list[Row], theirs: dict[str, tuple[float, ...]], name: str) -> Picture:
    labels = [TITLES[row["sequence"]] for row in rows]
    drawn = draw_plot(
        [
            Bars("Ours, twins", "mean px", labels, {"ours": [row["px"] for row in rows]}),
            Bars("T16, recordings", "mean px", labels, {"T16": [theirs[label][0] for label in labels]}, ("T16",)),
        ],
        "Mean error of each sequence, ours on twins and the paper's on recordings",
    )
    return Picture(name, drawn, "Each side has its own scale.")


def _describe_still(rows: list[Row]) -> str:
    """What still frames do to a mean."""
    return " ".join(
        f"In the authors' file the hand of {row['sequence']} stands still up to frame "
        f"{row['frames'] - row['moving_frames'] - 1}; from there on the mean is {row['moving_px']:.3f} px."
        for row in rows
        if 0 < row["moving_frames"] < row["frames"] - 1
    )


def _show_hands(rows: list[Row]) -> list[Block]:
    of = {TITLES[row["sequence"]]: row for row in rows}
    cells = []
    for title, theirs in paper.TABLE_7.items():
        row = of.get(title)
        ours = ("motion not public", *[""] * 7)
        if row is not None:
            ours = (
                f"{row['sequence']}, {row['frames']} frames",
                show_px(row["px"]),
                show_px(row["px_std"]),
                show_px(row["px_max"]),
                show_px(row["mm"]),
                show_px(row["worst_mm"]),
                str(row["lost"]),
                f"{row['median_ms']:.1f}",
            )
        cells.append((title, *ours, *(show_px(value) for value in theirs)))
    columns = ("sequence", "twin", "mean px", "std px", "max px", "mean mm", "worst frame mm", "lost", "median ms")
    return [
        Table((*columns, "T16 mean px", "T16 std px", "T16 max px"), tuple(cells), _describe_still(rows)),
        _plot(rows, paper.TABLE_7, "table_07"),
    ]


def _show_objects(rows: list[Row]) -> list[Block]:
    of = {TITLES[row["sequence"]]: row for row in rows}
    cells = []
    for title, theirs in paper.TABLE_14.items():
        row = of.get(title)
        ours = ("motion not public", *[""] * 7)
        if row is not None:
            (item,) = row["objects"].values()
            ours = (
                f"{row['sequence']}, {row['frames']} frames",
                show_px(row["px"]),
                show_px(row["px_std"]),
                show_px(row["mm"]),
                show_px(row["worst_mm"]),
                str(row["lost"]),
                show_px(item["mm"]),
                show_px(item["surface_mm"]),
            )
        cells.append((title, *ours, *(show_px(value) for value in theirs)))
    columns = ("sequence", "twin", "mean px", "std px", "mean mm", "worst frame mm", "lost", "object mm", "surface mm")
    return [
        Table(
            (*columns, "T16 mean px", "T16 std px"),
            tuple(cells),
            "Object: of a rigid one the centroid's error, of the pipe and the rope the mean over their bones; surface: "
            "its mean distance from the true one, which does not count turning or sliding along itself.",
        ),
        _plot(rows, paper.TABLE_14, "table_14"),
    ]


TABLE_7 = Study(
    name="table_07",
    title="Each sequence, hands with hands",
    paper="Table 7, §4.1.4",
    question="How exactly is each sequence followed?",
    same=SAME,
    differs=DIFFERS.format("Seven of the eleven motions are not public."),
    trials=lambda extent: _runs(HAND_HAND, "LO+SC", extent),
    tabulate=lambda results, extent: _tabulate(results, HAND_HAND, "LO+SC", extent),
    show=_show_hands,
)
TABLE_14 = Study(
    name="table_14",
    title="Each sequence, hands with objects",
    paper="Table 14, §4.2.2",
    question="How exactly is each sequence with an object followed?",
    same=SAME,
    differs=DIFFERS.format("Three of the seven motions are not public."),
    trials=lambda extent: _runs(HAND_OBJECT, "LO+SCP", extent),
    tabulate=lambda results, extent: _tabulate(results, HAND_OBJECT, "LO+SCP", extent),
    show=_show_objects,
)
