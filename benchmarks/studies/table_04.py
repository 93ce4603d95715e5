"""[T16] Table 4: the weight of the collision term."""

from __future__ import annotations

from benchmarks.studies import paper
from benchmarks.studies.blocks import Block, Picture, Table, Text
from benchmarks.studies.plain_run import PlainRun
from benchmarks.studies.plots import Lines, Series, draw_plot
from benchmarks.studies.settings import pooled, runs_of, show_lost, show_px
from benchmarks.studies.study import HAND_HAND, SETTING_STEP, Extent, Row, Study
from benchmarks.studies.trial import Results
from benchmarks.studies.true_penetration import TruePenetration

WEIGHTS = (0.0, 0.1, 0.3, 1.0, 3.0, 10.0)
"""Of each intruding vertex. The paper's belong to sums over pairs of triangles, which grow with the mesh."""

GROUPS = {"all": HAND_HAND, "severe": ("01",), "at least some": ("01", "04", "12"), "some": ("04", "12")}
"""As in §4.1.3: Walking has severe, Tips Touching and Bunny some, Flying no apparent collisions."""


def _truths(extent: Extent) -> dict[str, TruePenetration]:
    return {name: TruePenetration(name, SETTING_STEP, extent.frames) for name in HAND_HAND}


def trials(extent: Extent) -> list[PlainRun | TruePenetration]:
    swept = [run for weight in WEIGHTS for run in runs_of(HAND_HAND, extent, collision=weight)]
    return [*swept, *_truths(extent).values()]


def tabulate(results: Results, extent: Extent) -> list[Row]:
    truths = {name: results[trial] for name, trial in _truths(extent).items()}
    return [
        {
            "group": group,
            "weight": weight,
            **pooled(results, names, extent, collision=weight),
            "true_deepest_mm": max(truths[name]["deepest_mm"] for name in names),
        }
        for group, names in GROUPS.items()
        for weight in WEIGHTS
    ]


def show(rows: list[Row]) -> list[Block]:
    of = {group: [row for row in rows if row["group"] == group] for group in GROUPS}
    cells = tuple(
        (
            f"{weight:g}",
            *(show_px(of[group][n]["px"]) for group in GROUPS),
            show_px(of["all"][n]["mm"]),
            show_px(of["all"][n]["deepest_mm"]),
            show_px(of["all"][n]["mean_deepest_mm"]),
            show_lost(of["all"][n]),
        )
        for n, weight in enumerate(WEIGHTS)
    )
    theirs = tuple(
        (f"{weight:g}", *(show_px(paper.TABLE_4[group][n]) for group in GROUPS))
        for n, weight in enumerate(paper.TABLE_4_WEIGHT)
    )
    drawn = draw_plot(
        [
            Lines(
                "Ours, twins",
                "γ_c of a vertex",
                "mean px",
                [Series(group, WEIGHTS, [row["px"] for row in of[group]]) for group in GROUPS],
                even=True,
            ),
            Lines(
                "Deepest penetration, twins",
                "γ_c of a vertex",
                "mm",
                [Series(group, WEIGHTS, [row["deepest_mm"] for row in of[group]]) for group in GROUPS],
                even=True,
            ),
            Lines(
                "T16, recordings",
                "γ_c",
                "mean px",
                [Series(group, paper.TABLE_4_WEIGHT, paper.TABLE_4[group]) for group in GROUPS],
                even=True,
            ),
        ],
        "Mean error and deepest penetration by the weight of the collision term",
    )
    none, one = (next(row for row in of["all"] if row["weight"] == weight) for weight in (0.0, 1.0))
    return [
        Table(
            (
                "γ_c",
                *(f"{group}, mean px" for group in GROUPS),
                "all, mean mm",
                "deepest mm",
                "mean over frames of the deepest mm",
                "lost",
            ),
            cells,
            "Columns: sequences by how much their parts collide.",
        ),
        Table(("T16 γ_c", *(f"T16 {group}, mean px" for group in GROUPS)), theirs),
        Picture("table_04", drawn, "Weights stand at equal distances."),
        Text(
            f"From weight 0 to 1 the error goes from {none['px']:.2f} to {one['px']:.2f} px and the deepest "
            f"penetration from {none['deepest_mm']:.1f} to {one['deepest_mm']:.1f} mm (the motions themselves "
            f"interpenetrate by up to {one['true_deepest_mm']:.1f} mm)."
        ),
    ]


STUDY = Study(
    name="table_04",
    title="Weight of the collision term",
    paper="Table 4, §4.1.3",
    question="How hard should parts be kept out of each other?",
    same="The paper's groups of sequences, as far as their motions are public; penetration, which the paper could not "
    "measure, beside the error.",
    differs="Weights count intruding vertices, not pairs of triangles, so the columns do not match one to one; LO+C.",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
