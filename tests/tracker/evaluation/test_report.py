"""Reports hold the numbers, need nothing else, and let no name become code."""

from __future__ import annotations

import csv
import io
from html.parser import HTMLParser

import cv2
import numpy as np
import pytest

from tests.tracker.evaluation.judged import judge, make_evaluation
from tracker.evaluation.comparison import compare_tracks
from tracker.evaluation.evaluation import evaluate_track
from tracker.evaluation.report_csv import write_csv
from tracker.evaluation.report_html import write_html
from tracker.evaluation.worst_picture import SIZE, draw_item, encode_jpeg


class Page(HTMLParser):
    """What a report consists of."""

    VOID = frozenset({"meta", "img", "line", "circle", "polyline"})

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.addresses: list[str] = []
        self.words: list[str] = []
        self.open: list[str] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in self.VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)


@pytest.fixture
def judged():
    errors = np.random.default_rng(1).gamma(2.0, 3.0, (12, 21))
    return [
        judge("a", make_evaluation(errors), terms="LO"),
        judge("b", make_evaluation(errors + 1.5), terms="LO+SC"),
        judge("c", make_evaluation(errors[:6]), "<script>alert(1)</script>", terms="LO"),
    ]


def test_a_page_holds_the_numbers_and_nothing_that_is_fetched_or_run(judged) -> None:
    document = compare_tracks(judged, reference="a")
    text = write_html(document, {("a", 0): b"\xff\xd8\xff"}, title="<b>Mine</b>", made_at="today")
    page = Page(text)
    assert page.open == []
    words = " ".join(page.words)
    for track in document["tracks"]:
        for measure in ("mean", "std", "median", "p95", "max"):
            assert f"{track['error'][measure]:.2f}" in words
    assert f"{document['tracks'][1]['paired']['difference']:+.2f}" == "+1.50"
    assert "+1.50" in words and "worse" in words
    assert "<script>alert(1)</script>" in words and "script" not in page.tags, "a name is a name"
    assert "<b>Mine</b>" in words
    assert page.addresses == ["data:image/jpeg;base64,/9j/"]
    assert page.tags.count("polyline") == 3 + 3, "a curve of each track by frame, and one by threshold"


def test_a_table_has_a_row_for_every_marked_joint_and_no_name_is_a_formula(judged) -> None:
    visibility = np.full((12, 21), 2)
    visibility[0, :5] = (0, 1, 1, 2, 0)
    errors = np.where(visibility > 0, 1.25, np.nan)
    one = judge("a", make_evaluation(errors, visibility=visibility), "=cmd()")
    rows = list(csv.DictReader(io.StringIO(write_csv([one, judged[1]]))))
    assert len(rows) == 12 * 21 - 2 + 12 * 21
    assert [row["visibility"] for row in rows[:3]] == ["occluded", "occluded", "visible"]
    assert {row["recording"] for row in rows} == {"'=cmd()", "waving"}
    assert rows[0]["joint"] == "thumb_cmc" and rows[0]["error_px"] == "1.250"
    assert float(rows[0]["tracked_x"]) - float(rows[0]["marked_x"]) == pytest.approx(1.25)


def test_the_picture_of_a_frame_shows_marks_in_white_and_the_track_in_the_colour_of_its_error(known) -> None:
    evaluation = evaluate_track(known.track(), known.annotations)
    exact = draw_item(known.sequence, evaluation, 0)
    assert exact.shape == (SIZE[1], SIZE[0], 3)
    off = evaluation.tracked.copy()
    off[0] += (25.0, 0.0)
    moved = make_moved(evaluation, off)
    red = np.array((214, 48, 49))
    picture = draw_item(known.sequence, moved, 0)

    def count(image: np.ndarray, color: np.ndarray) -> int:
        return int((np.abs(image.astype(int) - color).max(axis=2) < 12).sum())

    assert count(picture, red) > 400 > 10 > count(exact, red), "25 px are beyond the scale's end: red"
    assert count(exact, np.array((255, 255, 255))) > 100
    back = cv2.imdecode(np.frombuffer(encode_jpeg(picture), np.uint8), cv2.IMREAD_COLOR)
    assert back is not None and back.shape == picture.shape


def test_a_picture_is_drawn_when_the_track_flew_off_or_projects_nowhere(known) -> None:
    evaluation = evaluate_track(known.track(), known.annotations)
    for value in (1e7, np.nan):
        moved = make_moved(evaluation, np.full_like(evaluation.tracked, value))
        assert draw_item(known.sequence, moved, 0).std() > 5


def make_moved(evaluation, tracked):
    from dataclasses import replace

    return replace(evaluation, tracked=tracked)
