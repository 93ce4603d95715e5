"""A trained hand model as a report: how it was trained, and how it does on people kept for testing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from tracker.evaluation.report_drawing import Line, draw_bar_cell, draw_curves
from tracker.evaluation.report_page import write_page, write_row, write_table

Document = Mapping[str, Any]

MOST_COMPONENTS = 30
"""Drawn of a space."""

HOW_TO = "Leave subjects out of the training set and choose to evaluate on them when you train, or in the loop."


def write_model_html(report: Document, *, title: str, made_at: str, facts: Mapping[str, str]) -> str:
    """The report of a trained model.

    Args:
        report: Of the training, with its `study`.
        title: Heading: the model's name.
        made_at: When, as it is to be shown.
        facts: More to say of the model, by name.
    """
    study = report.get("study", {})
    return write_page(
        title,
        [
            f"<p class=quiet>A hand model learnt from scans, [R17] section 3.3. Made {escape(made_at)}.</p>",
            _facts(report, facts),
            _held_out(study),
            _pose_curves(study),
            _shape_curve(study),
            _compactness(report),
            _residuals(report),
            _time(report, study),
        ],
    )


def _facts(report: Document, facts: Mapping[str, str]) -> str:
    told = {
        "Registrations": f"{report['registrations']} of {report['hands']} hands of {report['people']} people",
        "Distance to them, root mean square": f"{report['residual_mm']:.3f} mm",
        **facts,
    }
    if report["left_out"]:
        told["Too few registrations, left out"] = ", ".join(report["left_out"])
    for name, value in report["options"].items():
        told[name.replace("_", " ").capitalize()] = ", ".join(f"{v:g}" for v in value) if isinstance(value, list) else (
            "yes" if value is True else "no" if value is False else str(value)
        )  # fmt: skip
    rows = [write_row(name, [f'<td style="white-space:normal">{escape(text)}</td>']) for name, text in told.items()]
    return f"<h2>What it is</h2><div class=scroll><table><tbody>{''.join(rows)}</tbody></table></div>"


def _held_out(study: Document) -> str:
    if not study.get("models"):
        return f"<h2>People kept for testing</h2><p>It was not evaluated on any. {HOW_TO}</p>"
    parts = [
        f"<h2>People kept for testing</h2><p class=quiet>{study['scans']} scans of {len(study['people'])} people that "
        f"nothing was learnt from: {escape(', '.join(study['people']))}. Their registrations lie "
        f"{study['floor_mm']:.3f} mm from the scans. mm, less is better.</p>",
        "<h3>Pose and shape fitted</h3>",
        _models(study["models"]),
    ]
    if study["own_template"]:
        parts += ["<h3>Pose fitted, with a template of their own</h3>", _models(study["own_template"])]
    parts += [
        f"<p class=quiet>Not compared: {escape(name)}. {escape(why)}</p>" for name, why in study["not_compared"].items()
    ]
    return "".join(parts)


def _models(found: Mapping[str, Document]) -> str:
    full = {key: max(row[key] for row in found.values()) for key in ("scan_to_mesh_mm", "vertices_mm")}
    least = {key: min(row[key] for row in found.values()) for key in full}
    rows = []
    for name, row in found.items():
        text = f"{row['scan_to_mesh_mm']:.3f} ± {row['scan_to_mesh_sd_mm']:.3f}"
        cells = [
            draw_bar_cell(
                row[key],
                full[key],
                text if key == "scan_to_mesh_mm" else f"{row[key]:.3f}",
                len(found) > 1 and row[key] == least[key],
            )
            for key in full
        ]
        rows.append(write_row(name, cells))
    return write_table(["Model", "Scan to mesh", "Vertices of the registration"], rows)


def _pose_curves(study: Document) -> str:
    curves = study.get("pose_generalisation")
    if not curves:
        return ""
    label = "Generalisation of the pose space"
    return (
        f"<h2>{label}</h2><p class=quiet>Distance of scans of people kept for testing, by the number of pose "
        "components; [R17] Fig. 13.</p>"
        + draw_curves([Line.by_components(name, rows) for name, rows in curves.items()], label, "components", "mm")
        + _rows(curves)
    )


def _shape_curve(study: Document) -> str:
    rows = study.get("shape_generalisation")
    if not rows:
        return ""
    label = "Generalisation of the shape space"
    return (
        f"<h2>{label}</h2><p class=quiet>Mean absolute error of templates of people left out in turn, by the number of "
        "shape components; [R17] Fig. 14.</p>"
        + draw_curves([Line.by_components("people left out", rows)], label, "components", "mm")
        + _rows({"people left out": rows})
    )


def _rows(curves: Mapping[str, Sequence[Document]]) -> str:
    """The same as numbers."""
    counts = sorted({row["components"] for rows in curves.values() for row in rows})
    table = []
    for name, rows in curves.items():
        by_count = {row["components"]: row for row in rows}
        cells = [
            f"<td class=number>{by_count[count]['mean_mm']:.3f}</td>"
            if count in by_count
            else "<td class=number>–</td>"
            for count in counts
        ]
        table.append(write_row(name, cells))
    return write_table(["Components", *(str(count) for count in counts)], table)


def _compactness(report: Document) -> str:
    spaces = {"shape space": report["shape_space"], "pose space": report["pose_space"]}
    lines = [
        Line(
            name, list(range(1, len(shares[:MOST_COMPONENTS]) + 1)), [100 * share for share in shares[:MOST_COMPONENTS]]
        )
        for name, shares in spaces.items()
    ]
    label = "Compactness"
    return (
        f"<h2>{label}</h2><p class=quiet>Share of the variance that the first components explain together; [R17] "
        "Fig. 12.</p>" + draw_curves(lines, label, "components", "%", 100.0)
    )


def _residuals(report: Document) -> str:
    parts = ["<h2>Distance to what it was learnt from</h2><p class=quiet>Root mean square, mm.</p>"]
    rounds = "".join(f"<td class=number>{value:.3f}</td>" for value in report["rounds_mm"])
    names = ["first poses", *(f"round {n + 1}" for n in range(len(report["rounds_mm"]) - 2)), "last poses"]
    parts.append(write_table(["", *names], [write_row("All registrations", [rounds])]))
    for label, key in (("Hand", "by_hand"), ("Pose", "by_pose")):
        found = sorted(report[key].items(), key=lambda item: -item[1]["residual_mm"])
        full = max(row["residual_mm"] for _, row in found)
        rows = [
            write_row(
                name or "not named",
                [
                    draw_bar_cell(row["residual_mm"], full, f"{row['residual_mm']:.3f}"),
                    f"<td class=number>{row['registrations']}</td>",
                ],
            )
            for name, row in found
        ]
        parts += [f"<h3>By {label.lower()}</h3>", write_table([label, "mm", "Registrations"], rows)]
    return "".join(parts)


def _time(report: Document, study: Document) -> str:
    took = {**report["seconds"], **({"evaluation": study["seconds"]} if "seconds" in study else {})}
    full = max(took.values(), default=0.0)
    rows = [write_row(name, [draw_bar_cell(value, full, f"{value:.1f}")]) for name, value in took.items()]
    return "<h2>Time</h2>" + write_table(["Part", "s"], rows)
