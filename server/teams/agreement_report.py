"""The agreement of a replica set: measured from the database, as JSON, CSV and a page that stands alone."""

from __future__ import annotations

import csv
import io
import uuid
from collections.abc import Sequence
from dataclasses import asdict
from datetime import datetime
from html import escape
from itertools import product
from typing import Any

import numpy as np
import numpy.typing as npt
from pydantic import BaseModel, Field
from sqlalchemy import select
from sqlalchemy.orm import Session

from server.access.project_models import AssignmentRow, ReplicaSetRow
from server.access.service import find_names
from server.annotations.schemas import JointsOfSource, SourceChoice
from server.annotations.service import load_annotations
from server.database import utc_now
from server.sequences.models import SequenceRow
from server.teams.agreement import Agreement, measure_agreement
from server.teams.schemas import Hand
from tracker import HAND_JOINTS, Annotation
from tracker.capture import count_origins, describe_origin, find_counted, find_origin, say_left_out

Place = tuple[int, str, str]
"""A frame, a camera and a hand."""

WORST_PLACES = 50
T16_STD_PX = 1.46
"""Four annotators, [T16] Section 4.1."""


class SpreadOut(BaseModel):
    """A standard deviation."""

    std_px: float | None = Field(description="Along one image axis, px; null: nothing was placed twice.")
    samples: int = Field(description="Placed joints it comes from.")


class AgreementPerson(BaseModel):
    """One annotator."""

    assignment_id: uuid.UUID
    name: str
    hands: int = Field(description="Hands in images that they marked.")
    spread: SpreadOut
    bias_x_px: float | None = Field(description="Mean place against that of the others, px, + is right.")
    bias_y_px: float | None = Field(description="As before, + is down.")
    states: dict[str, SpreadOut]
    joints: list[SpreadOut]


class AgreementPair(BaseModel):
    """Two annotators."""

    first: str
    second: str
    joints: int = Field(description="Joints that both placed.")
    mean_px: float | None = Field(description="Mean distance.")
    oks: float | None = Field(description="Object keypoint similarity with the constants of COCO-WholeBody.")
    state_disagreement: float | None = Field(
        description="Share of joints that they call visible, occluded or absent differently."
    )


class AgreementJoint(BaseModel):
    """One joint."""

    joint: str
    spread: SpreadOut
    state_disagreement: float | None


class AgreementPlace(BaseModel):
    """One hand in one image."""

    frame: int
    camera: str
    hand: Hand
    spread: SpreadOut


class AgreementReport(BaseModel):
    """How well the annotators of a replica set agree."""

    replica_set_id: uuid.UUID
    sequence_id: uuid.UUID
    name: str
    recording: str
    made_at: datetime
    waiting: list[str] = Field(description="Annotators who have not submitted; they are left out.")
    source: list[SourceChoice] = Field(description="Joints that count, as asked for.")
    sources: list[JointsOfSource] = Field(description="Where the joints came from that count, or are left out.")
    left_out_joints: int = Field(description="Placed joints that do not count because of where they came from.")
    overall: SpreadOut
    radial_px: float | None = Field(description="√2 times the overall standard deviation: as a distance.")
    t16_std_px: float = Field(T16_STD_PX, description="Of the four annotators of [T16], for comparison.")
    oks: float | None = Field(description="Mean over the pairs.")
    are_separable: bool = Field(description="False for two annotators: both get the noise that they share.")
    states: dict[str, SpreadOut]
    joints: list[AgreementJoint]
    annotators: list[AgreementPerson]
    pairs: list[AgreementPair]
    worst: list[AgreementPlace] = Field(description="Hands about which they differ most, the worst first.")


def make_report(session: Session, replicas: ReplicaSetRow, source: Sequence[SourceChoice]) -> AgreementReport:
    """Measure the annotators of a replica set who have submitted, by the joints that came from one of `source`.

    Two people who accepted the same suggestion do not agree: they both believed a machine.
    """
    query = select(AssignmentRow).where(AssignmentRow.replica_set_id == replicas.id, AssignmentRow.deleted_at.is_(None))
    rows = session.scalars(query.order_by(AssignmentRow.created_at, AssignmentRow.id)).all()
    names = find_names(session, [row.account_id for row in rows])
    done = [row for row in rows if row.state in ("submitted", "accepted")]
    places = list(product(replicas.frames, replicas.cameras, replicas.hands))
    points, is_marked, is_counted, items = _load_joints(session, done, places, source)
    sources = _count_sources(items, source)
    sequence = session.get(SequenceRow, replicas.sequence_id)
    assert sequence is not None, "a foreign key"
    found = measure_agreement(points, is_marked, is_counted)
    people = [names[row.account_id] for row in done]
    similarities = [pair.oks for pair in found.pairs if pair.oks is not None]
    return AgreementReport.model_validate(
        {
            "replica_set_id": replicas.id,
            "sequence_id": replicas.sequence_id,
            "name": replicas.name,
            "recording": sequence.name,
            "made_at": utc_now(),
            "waiting": [names[row.account_id] for row in rows if row not in done],
            "source": list(source),
            "sources": sources,
            "left_out_joints": sum(one.joints for one in sources if not one.is_counted),
            "overall": asdict(found.overall),
            "radial_px": None if found.overall.std_px is None else np.sqrt(2) * found.overall.std_px,
            "oks": float(np.mean(similarities)) if similarities else None,
            "are_separable": len(done) > 2,
            "states": {name: asdict(spread) for name, spread in found.states.items()},
            "joints": [
                {"joint": joint, "spread": asdict(spread), "state_disagreement": share}
                for joint, spread, share in zip(HAND_JOINTS, found.joints, found.joint_disagreement, strict=True)
            ],
            "annotators": [
                _describe_person(found, person, row, people[person], int(is_marked[person].sum()))
                for person, row in enumerate(done)
            ],
            "pairs": [asdict(p) | {"first": people[p.first], "second": people[p.second]} for p in found.pairs],
            "worst": _find_worst(found, places),
        }
    )


def _load_joints(
    session: Session, rows: Sequence[AssignmentRow], places: Sequence[Place], source: Sequence[SourceChoice]
) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.bool_], npt.NDArray[np.bool_], list[Annotation]]:
    """What each person marked at each place.

    Returns:
        Points (A, P, 21, 3) of A people at P places, as annotations have them; whether a person marked a place (A, P);
        whether a joint counts (A, P, 21); and all annotations.
    """
    number = {place: index for index, place in enumerate(places)}
    points = np.zeros((len(rows), len(places), 21, 3))
    is_marked = np.zeros(points.shape[:2], dtype=bool)
    is_counted = np.ones(points.shape[:3], dtype=bool)
    items: list[Annotation] = []
    for person, row in enumerate(rows):
        for item in load_annotations(session, row.sequence_id, str(row.id)).items:
            place = number[item.frame, item.camera, item.hand]
            points[person, place], is_marked[person, place] = item.points, True
            is_counted[person, place] = find_counted(item.sources, source)
            items.append(item)
    return points, is_marked, is_counted, items


def _count_sources(items: Sequence[Annotation], source: Sequence[SourceChoice]) -> list[JointsOfSource]:
    """Placed joints of all annotators by where they came from: those that count first."""
    counted = [find_counted(item.sources, source) for item in items]
    return [
        JointsOfSource(origin=origin, words=words, joints=joints, is_counted=is_counted)
        for is_counted in (True, False)
        for (origin, words), joints in count_origins(
            (find_origin(item.sources, joint), describe_origin(item.sources, joint))
            for item, counts in zip(items, counted, strict=True)
            for joint in np.flatnonzero((item.points[:, 2] > 0) & (counts == is_counted)).tolist()
        )
    ]


def say_sources(report: AgreementReport) -> str:
    """How many joints do not count, and why; empty when all do."""
    return say_left_out((one.words, one.joints) for one in report.sources if not one.is_counted)


def _describe_person(found: Agreement, person: int, row: AssignmentRow, name: str, hands: int) -> dict[str, Any]:
    return {
        "assignment_id": row.id,
        "name": name,
        "hands": hands,
        "spread": asdict(found.people[person]),
        "bias_x_px": found.biases[person].x_px,
        "bias_y_px": found.biases[person].y_px,
        "states": {state: asdict(spread) for state, spread in found.people_states[person].items()},
        "joints": [asdict(spread) for spread in found.people_joints[person]],
    }


def _find_worst(found: Agreement, places: Sequence[Place]) -> list[dict[str, Any]]:
    measured = [
        (spread, place) for spread, place in zip(found.places, places, strict=True) if spread.std_px is not None
    ]
    measured.sort(key=lambda item: -(item[0].std_px or 0))
    return [
        {"frame": frame, "camera": camera, "hand": hand, "spread": asdict(spread)}
        for spread, (frame, camera, hand) in measured[:WORST_PLACES]
    ]


def write_csv(report: AgreementReport) -> str:
    """One figure a row: what it is of, the annotator, the joint or state, the figure."""
    out = io.StringIO()
    rows = csv.writer(out, lineterminator="\n")
    rows.writerow(["of", "annotator", "item", "std_px", "samples", "state_disagreement", "oks", "mean_px"])

    def add(of: str, who: str, item: str, spread: SpreadOut, *more: float | None) -> None:
        rows.writerow([of, _cell(who), _cell(item), spread.std_px, spread.samples, *more])

    add("overall", "", "", report.overall, None, report.oks)
    for one in report.sources:
        rows.writerow(["counted" if one.is_counted else "left out", "", _cell(one.words), None, one.joints])
    for state, spread in report.states.items():
        add("state", "", state, spread)
    for joint in report.joints:
        add("joint", "", joint.joint, joint.spread, joint.state_disagreement)
    for person in report.annotators:
        add("annotator", person.name, "", person.spread)
        for state, spread in person.states.items():
            add("annotator state", person.name, state, spread)
        for joint, spread in zip(report.joints, person.joints, strict=True):
            add("annotator joint", person.name, joint.joint, spread)
    for pair in report.pairs:
        both = f"{_cell(pair.first)} / {_cell(pair.second)}"
        rows.writerow(["pair", both, "", None, pair.joints, pair.state_disagreement, pair.oks, pair.mean_px])
    for place in report.worst:
        add("hand", "", f"frame {place.frame} {place.camera} {place.hand}", place.spread)
    return out.getvalue()


def _cell(text: str) -> str:
    """A text that no spreadsheet takes for a formula."""
    return f"'{text}" if text[:1] in ("=", "+", "-", "@", "\t", "\r") else text


STYLE = """
:root { color-scheme: light dark; font: 14px/20px system-ui, sans-serif; font-variant-numeric: tabular-nums; }
body { max-width: 960px; margin: 32px auto; padding: 0 24px; }
table { border-collapse: collapse; width: 100%; margin: 8px 0 32px; }
th, td { text-align: left; padding: 4px 16px 4px 0; border-bottom: 1px solid #8884; }
td.n, th.n { text-align: right; white-space: nowrap; }
td.bar { width: 40%; } td.bar div { height: 12px; background: #0ea394; border-radius: 2px; min-width: 1px; }
.big { font-size: 32px; line-height: 40px; font-weight: 650; } .quiet { opacity: .7; }
"""


def write_html(report: AgreementReport) -> str:
    """A page that needs nothing else: no script, no address, nothing to load."""
    scale = max((row.spread.std_px or 0 for row in (*report.joints, *report.annotators)), default=0) or 1

    def bars(title: str, rows: list[tuple[str, SpreadOut, str]], last: str) -> str:
        body = "".join(
            f"<tr><td>{escape(name)}</td><td class=n>{_px(spread.std_px)}</td>"
            f"<td class=bar><div style='width:{100 * (spread.std_px or 0) / scale:.1f}%'></div></td>"
            f"<td class=n>{spread.samples}</td><td class=n>{escape(more)}</td></tr>"
            for name, spread, more in rows
        )
        head = f"<th></th><th class=n>std, px</th><th></th><th class=n>joints</th><th class=n>{last}</th>"
        return f"<h2>{title}</h2><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    people = [(p.name, p.spread, f"{_signed(p.bias_x_px)}, {_signed(p.bias_y_px)}") for p in report.annotators]
    joints = [(j.joint.replace("_", " "), j.spread, _share(j.state_disagreement)) for j in report.joints]
    pairs = "".join(
        f"<tr><td>{escape(p.first)} and {escape(p.second)}</td><td class=n>{_px(p.mean_px)}</td>"
        f"<td class=n>{_score(p.oks)}</td><td class=n>{_share(p.state_disagreement)}</td></tr>"
        for p in report.pairs
    )
    worst = "".join(
        f"<tr><td>frame {p.frame}, {escape(p.camera)}, {p.hand} hand</td><td class=n>{_px(p.spread.std_px)}</td></tr>"
        for p in report.worst
    )
    waiting = f" Not submitted yet: {', '.join(map(escape, report.waiting))}." if report.waiting else ""
    shared = (
        "" if report.are_separable else " Two annotators cannot be separated: each is given the noise that they share."
    )
    count = f"{len(report.annotators)} annotators · {report.made_at:%Y-%m-%d %H:%M} UTC."
    pair_head = "<th></th><th class=n>mean distance, px</th><th class=n>OKS</th><th class=n>state differs</th>"
    return f"""<!doctype html><html lang="en"><meta charset="utf-8"><title>Agreement: {escape(report.name)}</title>
<style>{STYLE}</style><h1>{escape(report.name)}</h1>
<p class=quiet>{escape(report.recording)} · {count}{waiting}{shared} {escape(say_sources(report))}</p>
<p><span class=big>{_px(report.overall.std_px)} px</span> standard deviation along an image axis,
{_px(report.radial_px)} px as a distance, from {report.overall.samples} placed joints. Object keypoint similarity
(COCO-WholeBody) {_score(report.oks)}. The four annotators of [T16]: {report.t16_std_px} px.</p>
{bars("Annotators", people, "bias x, y, px")}
{bars("States", [(name, spread, "") for name, spread in report.states.items()], "")}
{bars("Joints", joints, "state differs")}
<h2>Pairs</h2><table><thead><tr>{pair_head}</tr></thead><tbody>{pairs}</tbody></table>
<h2>Where they differ most</h2>
<table><thead><tr><th></th><th class=n>std, px</th></tr></thead><tbody>{worst}</tbody></table></html>
"""


def _score(value: float | None) -> str:
    return "–" if value is None else f"{value:.3f}"


def _px(value: float | None) -> str:
    return "–" if value is None else f"{value:.2f}"


def _signed(value: float | None) -> str:
    return "–" if value is None else f"{value:+.2f}"


def _share(value: float | None) -> str:
    return "–" if value is None else f"{100 * value:.1f} %"
