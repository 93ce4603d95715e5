"""[T16] Table 5: distance fields against corresponding vertices."""

from __future__ import annotations

from benchmarks.studies import paper
from benchmarks.studies.blocks import Block, Picture, Table, Text
from benchmarks.studies.plain_run import PlainRun
from benchmarks.studies.plots import Bars, draw_plot
from benchmarks.studies.settings import pooled, runs_of, show_lost, show_px
from benchmarks.studies.study import HAND_HAND, Extent, Row, Study
from benchmarks.studies.table_04 import GROUPS
from benchmarks.studies.trial import Results

FORMS = {"none": (0.0, False), "corresponding vertices": (1.0, True), "distance fields": (1.0, False)}


def trials(extent: Extent) -> list[PlainRun]:
    return [
        run
        for weight, corresponding in FORMS.values()
        for run in runs_of(HAND_HAND, extent, collision=weight, corresponding=corresponding)
    ]


def tabulate(results: Results, extent: Extent) -> list[Row]:
    return [
        {
            "group": group,
            "form": form,
            **pooled(results, names, extent, collision=weight, corresponding=corresponding),
        }
        for group, names in GROUPS.items()
        for form, (weight, corresponding) in FORMS.items()
    ]


def show(rows: list[Row]) -> list[Block]:
    cells = []
    for row in rows:
        theirs = dict(zip(("corresponding vertices", "distance fields"), paper.TABLE_5[row["group"]], strict=True))
        cells.append(
            (
                row["group"],
                row["form"],
                show_px(row["px"]),
                show_px(row["mm"]),
                show_px(row["deepest_mm"]),
                show_px(row["mean_deepest_mm"]),
                show_lost(row),
                show_px(theirs.get(row["form"])),
            )
        )
    groups = list(GROUPS)
    of = {form: [row for row in rows if row["form"] == form] for form in FORMS}
    drawn = draw_plot(
        [
            Bars("Error, twins", "mean px", groups, {form: [row["px"] for row in of[form]] for form in FORMS}),
            Bars(
                "Deepest penetration, twins",
                "mm",
                groups,
                {form: [row["deepest_mm"] for row in of[form]] for form in FORMS},
            ),
        ],
        "Error and penetration with corresponding vertices and with distance fields",
    )
    simple, fields = (next(r for r in rows if r["group"] == "all" and r["form"] == form) for form in list(FORMS)[1:])
    return [
        Table(
            (
                "collisions",
                "term",
                "mean px",
                "mean mm",
                "deepest mm",
                "mean over frames of the deepest mm",
                "lost",
                "T16 mean px",
            ),
            tuple(cells),
        ),
        Picture("table_05", drawn, "All with weight 1 of a vertex, or without a term."),
        Text(
            f"Over all sequences corresponding vertices have {simple['px']:.2f} px and let parts "
            f"{simple['deepest_mm']:.1f} mm into each other; fields {fields['px']:.2f} px and "
            f"{fields['deepest_mm']:.1f} mm. "
            + (
                "As in the paper fields"
                if fields["px"] < simple["px"]
                else "Unlike in the paper corresponding vertices"
            )
            + " have the lower error."
        ),
    ]


STUDY = Study(
    name="table_05",
    title="Distance fields or corresponding vertices",
    paper="Table 5, §4.1.3",
    question="Are distance fields worth it, against moving vertices of colliding triangles to their counterpart?",
    same="The same replacement of the term, the same groups of sequences.",
    differs="The paper does not say how counterparts are found: here the nearest vertex of the crossed triangle.",
    trials=trials,
    tabulate=tabulate,
    show=show,
)
