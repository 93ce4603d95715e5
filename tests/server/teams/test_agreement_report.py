"""The agreement of a replica set as numbers, CSV and a page: who submitted counts, by the joints that count."""

from __future__ import annotations

import csv
import io
import re
import uuid
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from scipy.stats import chi

from server.access.places import Place
from server.access.project_models import AssignmentRow, ReplicaSetRow
from server.annotations.changes import Change, change_annotation
from server.database import Database
from server.teams import agreement_report
from server.teams.agreement_report import (
    T16_STD_PX,
    AgreementReport,
    SpreadOut,
    make_report,
    say_sources,
    write_csv,
    write_html,
)
from tests.server.teams.rows import Work
from tracker import HAND_JOINTS

FRAMES = [3, 5, 8]


@pytest.fixture
def database_kind() -> str:
    """One will do: what is asked here are plain queries."""
    return "sqlite"


@pytest.fixture
def work(database: Database) -> Iterator[Work]:
    with database.writing() as session:
        yield Work(session)


def take_part(work: Work, replicas: ReplicaSetRow, name: str, state: str = "submitted") -> AssignmentRow:
    frames = replicas.frames
    return work.assign(work.join(name), frames[0], frames[-1], replica_set_id=replicas.id, state=state)


def mark(work: Work, row: AssignmentRow, frame: int, x: float, v: Any = 2, sources: Any = None) -> None:
    """The wrist at this x, the joints 5 px below each other and a little to either side."""
    points = [
        [x + 9.0 * (joint % 4), 100.0 + 5.0 * joint, state]
        for joint, state in enumerate(np.broadcast_to(v, 21).tolist())
    ]
    place = Place(work.sequence.id, "cam0", frame, "right", str(row.id))
    change_annotation(work.session, place, Change("put", points, None, uuid.uuid4(), row.account_id, sources=sources))


def two_apart(work: Work, distances: dict[int, float]) -> AgreementReport:
    """The report of two people who mark each frame this far apart, px."""
    replicas = work.replicate("Week 1", list(distances))
    ann, bob = take_part(work, replicas, "ann"), take_part(work, replicas, "bob")
    for frame, distance in distances.items():
        mark(work, ann, frame, 50.0)
        mark(work, bob, frame, 50.0 + distance)
    return make_report(work.session, replicas, ["all"])


def test_two_who_differ_by_two_pixels_have_a_deviation_of_one_along_an_axis(work: Work) -> None:
    """s² = Σ |x - mean|² / Σ 2 (n - 1), each of the two being 1 px from the mean; its root is a little too small."""
    report = two_apart(work, dict.fromkeys(FRAMES, 2.0))
    freedom = 2 * 21 * len(FRAMES)
    expected = np.sqrt(freedom) / chi(freedom).mean()
    assert (report.overall.std_px, report.overall.samples) == (pytest.approx(expected), 2 * 21 * len(FRAMES))
    assert report.radial_px == pytest.approx(np.sqrt(2) * expected) and report.t16_std_px == T16_STD_PX
    assert [pair.mean_px for pair in report.pairs] == [pytest.approx(2.0)]
    assert report.oks == report.pairs[0].oks and 0.0 < (report.oks or 0.0) < 1.0
    biases = [(person.name, person.bias_x_px, person.bias_y_px) for person in report.annotators]
    assert biases == [("ann", pytest.approx(-2.0), 0.0), ("bob", pytest.approx(2.0), 0.0)]
    assert [person.hands for person in report.annotators] == [3, 3] and not report.are_separable
    assert [one.joint for one in report.joints] == list(HAND_JOINTS)


def test_hands_about_which_they_differ_most_come_first_and_no_more_than_the_page_lists(work: Work, monkeypatch) -> None:
    monkeypatch.setattr(agreement_report, "WORST_PLACES", 3)
    report = two_apart(work, {3: 1.0, 5: 4.0, 7: 3.0, 8: 2.0, 9: 0.5})
    assert [(one.frame, one.camera, one.hand) for one in report.worst] == [
        (frame, "cam0", "right") for frame in (5, 7, 8)
    ]


def test_who_has_not_submitted_waits_and_nothing_is_measured_of_one_alone(work: Work) -> None:
    replicas = work.replicate("Week 1", FRAMES)
    ann, bob = take_part(work, replicas, "ann", "accepted"), take_part(work, replicas, "bob", "returned")
    for row in (ann, bob):
        mark(work, row, 3, 50.0)
    report = make_report(work.session, replicas, ["all"])
    assert report.waiting == ["bob"] and [person.name for person in report.annotators] == ["ann"]
    assert (report.overall, report.radial_px, report.oks) == (SpreadOut(std_px=None, samples=0), None, None)
    assert (report.pairs, report.worst) == ([], [])


def test_a_set_in_which_nobody_has_marked_is_reported_with_nothing(work: Work) -> None:
    report = make_report(work.session, work.replicate("Week 1", FRAMES), ["all"])
    assert (report.annotators, report.waiting, report.sources, report.left_out_joints) == ([], [], [], 0)
    assert "– px" in write_html(report), "a page can be made of it all the same"


def test_who_was_withdrawn_is_in_no_report(work: Work) -> None:
    replicas = work.replicate("Week 1", FRAMES)
    row = take_part(work, replicas, "ann")
    row.deleted_at = work.project.created_at
    work.session.flush()
    report = make_report(work.session, replicas, ["all"])
    assert report.annotators == [] and report.waiting == []


def test_joints_from_a_machine_are_left_out_and_counted_by_where_they_came_from(work: Work) -> None:
    replicas = work.replicate("Week 1", [3])
    accepted = {"kind": "track", "label": "Track 1", "track_id": str(uuid.uuid4())}
    for name, x in (("ann", 50.0), ("bob", 52.0)):
        row = take_part(work, replicas, name)
        mark(work, row, 3, x, [2] * 20 + [0], [None] * 15 + [accepted] * 6)
    report = make_report(work.session, replicas, ["independent"])
    assert report.overall.samples == 2 * 15
    assert [(one.joints, one.is_counted) for one in report.sources] == [(30, True), (10, False)]
    assert report.left_out_joints == 10, "an absent joint is nobody's"
    assert "10 joints" in say_sources(report) and say_sources(report) in write_html(report).replace("&#x27;", "'")
    assert say_sources(make_report(work.session, replicas, ["all"])) == ""


def write_report(**changes: Any) -> AgreementReport:
    """Of two people and one joint, without a database."""
    spread = {"std_px": 1.25, "samples": 4}
    nothing = {"std_px": None, "samples": 0}
    person = {"assignment_id": uuid.uuid4(), "hands": 2, "spread": spread, "bias_x_px": 0.5, "bias_y_px": -0.25}
    person |= {"states": {"visible": spread}, "joints": [nothing]}
    pair = {"first": "ann", "second": "bob", "joints": 2, "mean_px": 2.0, "oks": 0.9, "state_disagreement": 0.125}
    document = {
        "replica_set_id": uuid.uuid4(),
        "sequence_id": uuid.uuid4(),
        "name": "Week 1",
        "recording": "waving",
        "made_at": "2026-05-04T12:30:00Z",
        "waiting": [],
        "source": ["all"],
        "sources": [{"origin": "hand", "words": "placed by hand", "joints": 4, "is_counted": True}],
        "left_out_joints": 0,
        "overall": spread,
        "radial_px": 1.77,
        "oks": 0.9,
        "are_separable": True,
        "states": {"visible": spread},
        "joints": [{"joint": "index_tip", "spread": spread, "state_disagreement": None}],
        "annotators": [person | {"name": "ann"}, person | {"name": "bob"}],
        "pairs": [pair],
        "worst": [{"frame": 3, "camera": "cam0", "hand": "right", "spread": spread}],
    }
    return AgreementReport.model_validate(document | changes)


def read(report: AgreementReport) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(write_csv(report))))


def test_the_table_has_every_figure_of_the_report_once() -> None:
    rows = read(write_report())
    assert [row["of"] for row in rows] == [
        *("overall", "counted", "state", "joint"),
        *("annotator", "annotator state", "annotator joint") * 2,
        *("pair", "hand"),
    ]
    assert (rows[0]["std_px"], rows[0]["samples"], rows[0]["oks"]) == ("1.25", "4", "0.9")
    assert rows[-2] == {
        "of": "pair",
        "annotator": "ann / bob",
        "item": "",
        "std_px": "",
        "samples": "2",
        "state_disagreement": "0.125",
        "oks": "0.9",
        "mean_px": "2.0",
    }
    assert rows[-1]["item"] == "frame 3 cam0 right"


@pytest.mark.parametrize("name", ["=1+1", "+1", "-1", "@x", "\tx"])
def test_no_name_becomes_a_formula_in_a_spreadsheet(name: str) -> None:
    document = write_report().model_dump()
    document["annotators"][0]["name"] = document["pairs"][0]["first"] = name
    rows = read(AgreementReport.model_validate(document))
    assert {row["annotator"] for row in rows if row["of"] == "annotator"} == {f"'{name}", "bob"}
    assert [row["annotator"] for row in rows if row["of"] == "pair"] == [f"'{name} / bob"]


def test_the_page_writes_numbers_as_people_read_them_and_a_dash_for_nothing() -> None:
    page = write_html(write_report())
    for told in ("1.25 px", "1.77 px", "0.900", "+0.50, -0.25", "12.5 %", "2026-05-04 12:30 UTC", "index tip"):
        assert told in page, told
    assert "<td class=n>–</td></tr>" in page, "no share is known of the joint"
    assert "cannot be separated" not in page and "Not submitted yet" not in page


def test_the_longest_bar_fills_its_column_and_without_any_figure_none_has_a_length() -> None:
    lengths = re.findall(r"width:([\d.]+)%'", write_html(write_report()))
    assert max(map(float, lengths)) == 100.0
    nothing = {"std_px": None, "samples": 0}
    document = write_report(annotators=[], states={}, joints=[], overall=nothing).model_dump()
    document["joints"] = [{"joint": "wrist", "spread": nothing, "state_disagreement": None}]
    assert re.findall(r"width:([\d.]+)%'", write_html(AgreementReport.model_validate(document))) == ["0.0"]


def test_no_name_becomes_markup_on_the_page() -> None:
    odd = "<script>alert('x')</script>"
    document = write_report(name=odd, recording=odd, waiting=[odd], are_separable=False).model_dump()
    document["annotators"][0]["name"] = document["pairs"][0]["first"] = document["worst"][0]["camera"] = odd
    page = write_html(AgreementReport.model_validate(document))
    assert "<script" not in page and page.count("&lt;script&gt;") == 7
    assert "Two annotators cannot be separated" in page and "Not submitted yet: &lt;script&gt;" in page
