"""A comparison's page has a section for what there is to compare and none for what there is not."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.tracker.evaluation.judged import judge, make_evaluation
from tests.tracker.evaluation.test_report import Page
from tracker.capture.joint_source import JointSource
from tracker.evaluation.comparison import JudgedTrack, compare_tracks
from tracker.evaluation.report_html import write_html

EVEN = np.full((4, 21), 4.0)


def write(judged: list[JudgedTrack], pictures: dict | None = None, **options: Any) -> str:
    document = compare_tracks(judged, **options)
    return write_html(document, pictures or {}, title="Compared", made_at="today", about="Frame 0 is left out.")


def read(text: str) -> str:
    page = Page(text)
    assert page.open == []
    return " ".join(" ".join(page.words).split())


def list_titles(text: str) -> list[str]:
    return [part.split("</h2>")[0] for part in text.split("<h2>")[1:]]


def test_one_track_is_compared_with_nothing() -> None:
    text = write([judge("a", make_evaluation(EVEN))])
    assert list_titles(text) == [
        *("Error", "Curves", "Joints", "Parameters", "Worst frames", "What was judged, and by which labels"),
    ]
    words = read(text)
    assert "Made today. Frame 0 is left out." in words and 'class="best"' not in text
    assert "Track a 4.00 0.00 4.00 4.00 4.00 100.0 % 4.00 – 84 4 4 0" in words, "nothing was occluded"


def test_a_track_is_named_with_its_recording_only_where_there_are_several() -> None:
    one, other = judge("a", make_evaluation(EVEN)), judge("b", make_evaluation(EVEN + 1))
    assert "Track a of waving" not in read(write([one, other]))
    assert "Track a of waving" in read(write([one, judge("b", make_evaluation(EVEN), "pointing")]))


@pytest.mark.parametrize(
    ("off", "kind", "said"),
    [(-1.0, "better", "-1.00 -1.00 to -1.00 100 % 84 4 better"), (1.0, "worse", "+1.00 +1.00 to +1.00 0 % 84 4 worse")],
)
def test_the_verdict_is_that_of_the_interval(off: float, kind: str, said: str) -> None:
    text = write([judge("a", make_evaluation(EVEN)), judge("b", make_evaluation(EVEN + off))], reference="a")
    assert "Against Track a" in list_titles(text) and said in read(text) and f'<td class="{kind}">' in text


def test_an_interval_about_zero_shows_no_difference() -> None:
    off = np.array([1.0, -1.0, 1.0, -1.0])[:, None]
    text = write([judge("a", make_evaluation(EVEN)), judge("b", make_evaluation(EVEN + off))], reference="a")
    assert "no difference seen" in read(text) and 'class="better"' not in text and 'class="worse"' not in text


def test_methods_and_recordings_appear_when_there_are_two_of_both() -> None:
    judged = [
        judge(f"{method}{place}", make_evaluation(EVEN + add), recording, terms=method)
        for place, recording in enumerate(("waving", "pointing"))
        for method, add in (("x", 0.0), ("y", 2.0))
    ]
    titles = list_titles(write(judged, reference="x0"))
    assert "Methods over all recordings" in titles and "Recordings" in titles
    assert "Methods over all recordings" not in list_titles(write(judged[:2])), "one recording"
    alone = list_titles(write([judged[0], judged[2]]))
    assert "Recordings" in alone and "Methods over all recordings" not in alone, "one method"


def test_joints_that_a_track_made_are_told_not_to_judge() -> None:
    left_out = np.zeros((4, 21), dtype=bool)
    left_out[0] = True
    sources = ((JointSource("track", "Track <9>"),) * 21, *(None,) * 3)
    error = np.where(left_out, np.nan, EVEN)
    words = read(write([judge("a", make_evaluation(error, left_out=left_out, sources=sources))]))
    assert "Track a: judged by 63 of unknown origin." in words and "accepted from Track <9>" in words
    assert "judged by no joint" in read(
        write([judge("a", make_evaluation(np.full((1, 21), np.nan), left_out=left_out[:1], sources=sources[:1]))])
    )


def test_parameters_that_differ_stand_in_a_table_and_those_alike_in_one_line() -> None:
    errors = make_evaluation(EVEN)
    words = read(write([judge("a", errors, terms="L", rate=3), judge("b", errors, terms="<M>", rate=3)]))
    assert "Differing Track a Track b terms L <M>" in words and "The same in all: rate 3." in words
    assert "Differing" not in read(write([judge("a", errors, rate=3), judge("b", errors, rate=3)]))


def test_a_joint_has_its_mean_spread_and_largest_and_a_dash_where_nobody_marked_it() -> None:
    error = EVEN.copy()
    error[:, 1] = [1.0, 3.0, 1.0, 3.0]
    error[:, 2] = np.nan
    words = read(write([judge("a", make_evaluation(error))]))
    assert "thumb cmc 2.00 ± 1.00 (3.0) thumb mcp – thumb ip 4.00 ± 0.00 (4.0)" in words


def test_a_worst_frame_is_described_with_its_picture_or_without() -> None:
    error = EVEN.copy()
    error[2, 8] = 30.0
    evaluation = make_evaluation(error, status=("ok", "ok", "lost", "ok"))
    text = write([judge("a", evaluation)], {("a", 0): b"jpeg", ("b", 0): b"nobody's"})
    assert "frame 2, cam0, right hand: 5.24 px, index tip 30.0 px, lost" in read(text)
    assert text.count("<img") == 1 and 'src="data:image/jpeg;base64,anBlZw=="' in text
    assert text.count("<figcaption>") == 4


def test_nothing_marked_makes_a_page_without_numbers() -> None:
    text = write([judge("a", make_evaluation(np.zeros((0, 21))))])
    words = read(text)
    assert "nan" not in words.lower().split() and "Nothing to draw." in words
    assert "Track a – – – – – – – – 0 0 1 0" in words
