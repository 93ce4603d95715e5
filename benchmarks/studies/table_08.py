"""[T16] Table 8: against the particle swarm of Oikonomidis et al."""

from __future__ import annotations

from benchmarks.studies import paper
from benchmarks.studies.against_swarm import AgainstSwarm
from benchmarks.studies.blocks import Block, Picture, Table, Text
from benchmarks.studies.plots import Bars, draw_plot
from benchmarks.studies.settings import show_px
from benchmarks.studies.study import TITLES, Extent, Row, Study
from benchmarks.studies.trial import Results

CASES = (("09", 1), ("09", 3), ("12", 1), ("12", 3))
"""Sequences of one hand, as in the paper, and every so many frames."""

SETTINGS = ((25, 64), (40, 64), (40, 128), (45, 64))
EQUAL_TIME = (64, 128)
NAMES = ("ours", *(f"{g} x {p}" for g, p in SETTINGS), *(f"equal time, {p}" for p in EQUAL_TIME))


def trials(extent: Extent) -> list[AgainstSwarm]:
    tracked, repeats = (8, 1) if extent.quick else (40, 2)
    return [AgainstSwarm(name, step, tracked, SETTINGS, EQUAL_TIME, repeats) for name, step in CASES]


def tabulate(results: Results, extent: Extent) -> list[Row]:
    return [
        {"sequence": trial.sequence, "step": trial.step, "repeats": trial.repeats, **row}
        for trial in trials(extent)
        for row in results[trial]["rows"]
    ]


def worst_ratio(rows: list[Row], names: tuple[str, ...]) -> float:
    """The error of ours over that of a swarm in the case that is worst for us."""
    of = {(row["sequence"], row["step"], row["tracker"]): row["px"] for row in rows}
    return max(of[*case, "ours"] / of[*case, name] for case in CASES for name in names)


def show(rows: list[Row]) -> list[Block]:
    cells = tuple(
        (
            f"{row['sequence']} {TITLES[row['sequence']]}, {'every' if row['step'] == 1 else 'every 3rd'}",
            row["tracker"],
            show_px(row["px"]),
            show_px(row["px_std"]),
            show_px(row["px_max"]),
            show_px(row["mm"]),
            str(row["lost"]),
            f"{row['generations']:.0f}",
            f"{row['median_ms']:.0f}",
        )
        for row in rows
    )
    theirs = tuple((name, *(show_px(value) for value in values)) for name, values in paper.TABLE_8.items())
    labels = [f"{name}{'' if step == 1 else ', every 3rd'}" for name, step in CASES]
    values = {
        name: [
            next(r["px"] for r in rows if (r["sequence"], r["step"], r["tracker"]) == (*case, name)) for case in CASES
        ]
        for name in NAMES
    }
    drawn = draw_plot([Bars("Ours and swarms, twins", "mean px", labels, values)], "Error of ours and of swarms")
    frames, repeats = rows[0]["frames"], rows[0]["repeats"]
    return [
        Table(
            (
                "twin, frames",
                "tracker",
                "mean px",
                "std px",
                "max px",
                "mean mm",
                "lost frames",
                "generations or iterations",
                "median ms",
            ),
            cells,
            f"{frames} frames of each, from where the hand begins to move (12: frame 419). "
            f"{repeats} run(s) of each swarm, lost frames of all of them.",
        ),
        Table(("T16: generations x particles", "T16 mean px", "T16 std px", "T16 max px"), theirs),
        Picture("table_08", drawn, "Generations x particles, and swarms that have as long as ours."),
        Text(
            "In the case that is worst for us ours has "
            f"{worst_ratio(rows, ('40 x 64', '40 x 128')):.2f} of the swarm's error at 40 generations and "
            f"{worst_ratio(rows, NAMES[-2:]):.3f} at equal time; T16's best ratio is 3.76 / 8.09 = 0.46."
        ),
    ]


STUDY = Study(
    name="table_08",
    title="Against a particle swarm",
    paper="Table 8, §4.1.5",
    question="Is local optimisation better than a swarm, at its settings and at equal time?",
    same="The ratio of the two errors: both follow the same images. Swarms of the paper's four settings, one hand.",
    differs="The swarm is written anew on our model and renderer (docs/evaluation.md) and runs on the processor; in "
    "the paper it is the authors' program, with its own model, on a graphics card. It starts from our first pose.",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
