"""A comparison as a report."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from html import escape
from typing import Any

from tracker.capture.source_choice import say_left_out
from tracker.evaluation.comparison import word_of
from tracker.evaluation.error_color import ANCHORS
from tracker.evaluation.report_drawing import Line, draw_bar_cell, draw_curves
from tracker.evaluation.report_page import write_page, write_row, write_table
from tracker.evaluation.worst_picture import FULL_PX

Document = Mapping[str, Any]
Pictures = Mapping[tuple[str, int], bytes]
"""JPEG files by a track's key and the place in its `worst`."""

STATISTICS = (("mean", "Mean"), ("std", "Std"), ("median", "Median"), ("p95", "95 %"), ("max", "Max"))


def write_html(document: Document, pictures: Pictures, *, title: str, made_at: str, about: str = "") -> str:
    """The report of a comparison (`compare_tracks`).

    Args:
        document: The comparison.
        pictures: Those of worst frames that there are.
        title: Heading.
        made_at: When, as it is to be shown.
        about: What was left out or chosen, one sentence.
    """
    tracks = document["tracks"]
    names = {track["key"]: _name(track, tracks) for track in tracks}
    parts = [
        f"<p class=quiet>Distance in the image between annotated and tracked joints, px. Made {escape(made_at)}. "
        f"{escape(about)}</p>",
        _summary(document, names),
        _left_out(tracks, names),
        _paired(document, names),
        _methods(document),
        _sequences(tracks),
        _curves(document, names),
        _joints(document, names),
        _parameters(document, names),
        _worst(tracks, names, pictures),
        _lineage(tracks, names),
    ]
    return write_page(title, parts)


def _name(track: Document, tracks: Sequence[Document]) -> str:
    is_one = len({other["recording_key"] for other in tracks}) == 1
    return track["name"] if is_one else f"{track['name']} of {track['recording']}"


def _column(rows: Sequence[Document], group: str, measure: str) -> tuple[float, float | None]:
    """The largest and the smallest value of a column; the smallest only where there is a choice."""
    values = [row[group][measure] for row in rows if row[group][measure] is not None]
    return max(values, default=0.0), min(values) if len(values) > 1 else None


def _summary(document: Document, names: Mapping[str, str]) -> str:
    tracks = document["tracks"]
    extent = {key: _column(tracks, "error", key) for key, _ in STATISTICS}
    seen = {group: _column(tracks, group, "mean") for group in ("visible", "occluded")}
    within = document["within_px"]
    rows = []
    for track in tracks:
        cells = [
            draw_bar_cell(track["error"][key], extent[key][0], best=track["error"][key] == extent[key][1])
            for key, _ in STATISTICS
        ]
        share = track["within"]
        cells.append(draw_bar_cell(share, 1.0, None if share is None else f"{100 * share:.1f} %"))
        cells += [draw_bar_cell(track[group]["mean"], seen[group][0]) for group in ("visible", "occluded")]
        counts = (track["error"]["count"], track["annotated_frames"], track["frames"], track["lost"])
        cells += [f"<td class=number>{count}</td>" for count in counts]
        rows.append(write_row(names[track["key"]], cells))
    head = ["Track", *(label for _, label in STATISTICS), f"Within {within:g} px", "Visible", "Occluded"]
    return "<h2>Error</h2>" + write_table([*head, "Joints", "Annotated frames", "Frames", "Lost"], rows)


def _left_out(tracks: Sequence[Document], names: Mapping[str, str]) -> str:
    """How many joints did not judge, and why."""
    said = []
    for track in tracks:
        told = say_left_out((one["words"], one["joints"]) for one in track["sources"] if not one["is_counted"])
        judged = ", ".join(f"{one['joints']} {one['words']}" for one in track["sources"] if one["is_counted"])
        said.append(f"<li>{escape(names[track['key']])}: judged by {escape(judged or 'no joint')}. {escape(told)}</li>")
    return (
        "<p class=quiet>Joints that a track had a part in do not judge a track, unless they were asked for.</p>"
        f"<ul class=quiet>{''.join(said)}</ul>"
    )


def _difference_cells(paired: Document) -> list[str]:
    difference, low, high = paired["difference"], paired["low"], paired["high"]
    kind, word = (
        ("better", "better") if high < 0 else ("worse", "worse") if low > 0 else ("quiet", "no difference seen")
    )
    return [
        f"<td class=number>{paired['mean']:.2f}</td><td class=number>{paired['reference_mean']:.2f}</td>",
        f'<td class="number {kind}">{difference:+.2f}</td>',
        f"<td class=number>{low:+.2f} to {high:+.2f}</td>",
        f"<td class=number>{100 * paired['better']:.0f} %</td>",
        f"<td class=number>{paired['joints']}</td><td class=number>{paired['frames']}</td>",
        f'<td class="{kind}">{word}</td>',
    ]


def _paired(document: Document, names: Mapping[str, str]) -> str:
    found = [track for track in document["tracks"] if track["paired"] is not None]
    if not found:
        return ""
    rows = [write_row(names[track["key"]], _difference_cells(track["paired"])) for track in found]
    reference = names[document["reference"]]
    head = ["Track", "Mean", "Reference", "Difference", "95 % interval", "Nearer in", "Joints", "Frames", "Verdict"]
    return (
        f"<h2>Against {escape(reference)}</h2><p class=quiet>Over the joints and frames that both have; below zero is "
        "better. The interval is a bootstrap over frames.</p>" + write_table(head, rows)
    )


def _methods(document: Document) -> str:
    methods = document["methods"]
    if len(methods) < 2 or len({track["recording_key"] for track in document["tracks"]}) < 2:
        return ""
    extent = {key: _column(methods, "error", key) for key, _ in STATISTICS}
    rows = []
    for method in methods:
        cells = [
            draw_bar_cell(method["error"][key], extent[key][0], best=method["error"][key] == extent[key][1])
            for key, _ in STATISTICS
        ]
        paired = method["paired"]
        shown = "reference" if method["is_reference"] else "–"
        if paired is not None:
            shown = f"{paired['difference']:+.2f} ({paired['low']:+.2f} to {paired['high']:+.2f})"
        counts = (method["recordings"], method["frames"], method["lost"])
        cells += [f"<td class=number>{count}</td>" for count in counts]
        rows.append(write_row(method["name"], [*cells, f"<td class=number>{escape(shown)}</td>"]))
    head = ["Method", *(label for _, label in STATISTICS), "Recordings", "Frames", "Lost", "Difference"]
    return "<h2>Methods over all recordings</h2>" + write_table(head, rows)


def _sequences(tracks: Sequence[Document]) -> str:
    """As [T16] Table 7: sequences across, mean, standard deviation and maximum down."""
    recordings = dict.fromkeys((track["recording_key"], track["recording"]) for track in tracks)
    if len(recordings) < 2:
        return ""
    chosen = [next(track for track in tracks if track["recording_key"] == key) for key, _ in recordings]
    rows = []
    for measure, label in (("mean", "Mean error (px)"), ("std", "Standard deviation (px)"), ("max", "Max error (px)")):
        full = max((track["error"][measure] or 0.0 for track in chosen), default=0.0)
        rows.append(write_row(label, [draw_bar_cell(track["error"][measure], full) for track in chosen]))
    head = ["", *(f"{track['recording']}: {track['name']}" for track in chosen)]
    return "<h2>Recordings</h2>" + write_table(head, rows)


def _curves(document: Document, names: Mapping[str, str]) -> str:
    parts = []
    for key in dict.fromkeys(track["recording_key"] for track in document["tracks"]):
        fellows = [track for track in document["tracks"] if track["recording_key"] == key]
        label = f"Mean error by frame, {fellows[0]['recording']}"
        lines = [Line(names[t["key"]], t["curve"]["frame"], t["curve"]["mean"], reach=1) for t in fellows]
        parts.append(f"<h3>{escape(label)}</h3>" + draw_curves(lines, label, "frame", "px"))
    thresholds = document["thresholds_px"]
    lines = [
        Line(names[t["key"]], thresholds, [None if share is None else 100 * share for share in t["shares"]])
        for t in document["tracks"]
    ]
    label = "Share of joints below an error (PCK)"
    parts.append(f"<h3>{label}</h3>" + draw_curves(lines, label, "px", "%", top=100.0))
    return "<h2>Curves</h2>" + "".join(parts)


def _joints(document: Document, names: Mapping[str, str]) -> str:
    tracks = document["tracks"]
    full = max((row["mean"] or 0.0 for track in tracks for row in track["by_joint"]), default=0.0)
    rows = [
        write_row(
            joint.replace("_", " "),
            [
                draw_bar_cell(found["mean"], full, None if found["mean"] is None else _mean_std(found))
                for found in (track["by_joint"][place] for track in tracks)
            ],
        )
        for place, joint in enumerate(document["joints"])
    ]
    head = ["Joint", *(names[track["key"]] for track in tracks)]
    return "<h2>Joints</h2><p class=quiet>Mean ± standard deviation (largest), px.</p>" + write_table(head, rows)


def _mean_std(found: Document) -> str:
    return f"{found['mean']:.2f} ± {found['std']:.2f} ({found['max']:.1f})"


def _parameters(document: Document, names: Mapping[str, str]) -> str:
    tracks, parameters = document["tracks"], document["parameters"]
    same = ", ".join(f"{name} {word_of(value)}" for name, value in parameters["same"].items())
    alike = f"<p class=quiet>The same in all: {escape(same)}.</p>" if same else ""
    if not parameters["different"]:
        return f"<h2>Parameters</h2>{alike}"
    rows = [
        write_row(item["name"], [f"<td class=number>{escape(word_of(item['values'][t['key']]))}</td>" for t in tracks])
        for item in parameters["different"]
    ]
    return "<h2>Parameters</h2>" + write_table(["Differing", *(names[t["key"]] for t in tracks)], rows) + alike


def _worst(tracks: Sequence[Document], names: Mapping[str, str], pictures: Pictures) -> str:
    gradient = ", ".join(f"rgb({red:.0f} {green:.0f} {blue:.0f})" for red, green, blue in ANCHORS)
    parts = [
        "<h2>Worst frames</h2><p class=quiet>White rings: marked by people (filled: visible). Crosses: tracked, "
        f'<span class=scale style="background:linear-gradient(90deg, {gradient})"></span> 0 to {FULL_PX:g} px and '
        "more.</p>"
    ]
    for track in tracks:
        shown = []
        for place, item in enumerate(track["worst"]):
            data = pictures.get((track["key"], place))
            text = (
                f"frame {item['frame']}, {item['camera']}, {item['hand']} hand: {item['mean_px']:.2f} px, "
                f"{item['worst_joint'].replace('_', ' ')} {item['max_px']:.1f} px"
                + (f", {item['status']}" if item["status"] != "ok" else "")
            )
            image = ""
            if data is not None:
                code = base64.b64encode(data).decode()
                image = f'<img alt="{escape(text)}" src="data:image/jpeg;base64,{code}">'
            shown.append(f"<figure>{image}<figcaption>{escape(text)}</figcaption></figure>")
        if shown:
            parts.append(f"<h3>{escape(names[track['key']])}</h3><div class=pictures>{''.join(shown)}</div>")
    return "".join(parts)


def _lineage(tracks: Sequence[Document], names: Mapping[str, str]) -> str:
    rows = []
    for track in tracks:
        facts = {**track["labels"], **{f"track {name}": value for name, value in track["origin"].items()}}
        text = "; ".join(f"{name.replace('_', ' ')} {value}" for name, value in facts.items() if value is not None)
        rows.append(
            write_row(names[track["key"]], [f'<td style="white-space:normal"><code>{escape(text)}</code></td>'])
        )
    body = "".join(rows)
    return f"<h2>What was judged, and by which labels</h2><div class=scroll><table><tbody>{body}</tbody></table></div>"
