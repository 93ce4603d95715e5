"""[T16] Table 11: friction in the search for contacts."""

from __future__ import annotations

from benchmarks.studies import paper
from benchmarks.studies.blocks import Block, Table, Text
from benchmarks.studies.plain_run import PlainRun
from benchmarks.studies.settings import pooled, runs_of, show_px
from benchmarks.studies.study import HAND_OBJECT, Extent, Row, Study
from benchmarks.studies.trial import Results

WEIGHT = 10.0
"""γ_ph, as the paper has for this table."""


def trials(extent: Extent) -> list[PlainRun]:
    return [run for value in paper.TABLE_11_FRICTION for run in _runs(value, extent)]


def _runs(friction: float, extent: Extent) -> list[PlainRun]:
    return runs_of(HAND_OBJECT, extent, collision=1.0, physics=WEIGHT, friction=friction)


def tabulate(results: Results, extent: Extent) -> list[Row]:
    return [
        {
            "friction": value,
            **pooled(results, HAND_OBJECT, extent, collision=1.0, physics=WEIGHT, friction=value),
        }
        for value in paper.TABLE_11_FRICTION
    ]


def show(rows: list[Row]) -> list[Block]:
    cells = tuple(
        (
            f"{row['friction']:g}",
            show_px(row["px"]),
            show_px(row["px_std"]),
            show_px(row["mm"]),
            show_px(paper.TABLE_11["mean"][n]),
            show_px(paper.TABLE_11["std"][n]),
        )
        for n, row in enumerate(rows)
    )
    spread = max(row["px"] for row in rows) - min(row["px"] for row in rows)
    return [
        Table(("friction", "mean px", "std px", "mean mm", "T16 mean px", "T16 std px"), cells),
        Text(f"Over all values the means lie within {spread:.3f} px of each other; T16's within 0.02."),
    ]


STUDY = Study(
    name="table_11",
    title="Friction",
    paper="Table 11, §4.2.1",
    question="Does the friction of hands and objects matter to the error?",
    same="The same values and γ_ph = 10; whether the error depends on them.",
    differs="Four of seven sequences; no static scene, for the twins have none; terms LO+CP; every third frame.",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
