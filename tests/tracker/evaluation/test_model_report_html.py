"""A model's report from numbers written down by hand: what was not measured is not claimed, the best is marked."""

from __future__ import annotations

from typing import Any

import pytest

from tests.tracker.evaluation.test_report import Page
from tracker.evaluation.model_report_html import HOW_TO, MOST_COMPONENTS, write_model_html

REPORT: dict[str, Any] = {
    "registrations": 90,
    "hands": 6,
    "people": 5,
    "residual_mm": 1.23456,
    "left_out": {},
    "options": {"rounds": 3, "with_mirrored": True, "with_pose_shapes": False, "ridges": [0.5, 1e-3]},
    "rounds_mm": [3.0, 2.0, 1.5, 1.25],
    "by_hand": {"a": {"residual_mm": 1.0, "registrations": 40}, "": {"residual_mm": 2.0, "registrations": 50}},
    "by_pose": {"fist": {"residual_mm": 1.5, "registrations": 90}},
    "shape_space": [0.5, 0.8, 0.9],
    "pose_space": [0.02 * n for n in range(1, 46)],
    "seconds": {"fit": 12.34},
}
RATES = {
    name: {"scan_to_mesh_mm": scan, "scan_to_mesh_sd_mm": 0.25, "vertices_mm": vertices}
    for name, scan, vertices in (("learned", 1.0, 2.5), ("plain", 1.5, 2.0))
}
STUDY: dict[str, Any] = {
    "people": ["p1", "p2"],
    "scans": 24,
    "floor_mm": 0.4567,
    "models": RATES,
    "own_template": {},
    "not_compared": {},
    "seconds": 6.0,
}


def write(report: dict[str, Any] = REPORT, study: dict[str, Any] | None = None, **facts: str) -> str:
    told = report if study is None else report | {"study": study}
    return write_model_html(told, title="Hand 1", made_at="today", facts=facts)


def read(text: str) -> str:
    page = Page(text)
    assert page.open == [], "every tag ends"
    return " ".join(" ".join(page.words).split())


def test_options_are_told_in_words_and_facts_beside_them() -> None:
    words = read(write(round="<2>"))
    for said in ("90 of 6 hands of 5 people", "1.235 mm", "round <2>", "Rounds 3", "Ridges 0.5, 0.001"):
        assert said in words
    assert "With mirrored yes" in words and "With pose shapes no" in words
    assert "Too few registrations" not in words
    assert "Too few registrations, left out s1, s2" in read(write(REPORT | {"left_out": {"s1": 2, "s2": 1}}))


@pytest.mark.parametrize("study", [None, {}, STUDY | {"models": {}}])
def test_a_model_that_was_not_judged_says_how_it_could_have_been(study: dict | None) -> None:
    words = read(write(study=study))
    assert f"It was not evaluated on any. {HOW_TO}" in words and "Scan to mesh" not in words


def test_the_least_of_each_column_is_marked_and_bars_are_shares_of_the_largest() -> None:
    text = write(study=STUDY)
    assert text.count('class="best"') == 2
    assert '<span class="best" title="the smallest of its column">1.000 ± 0.250</span>' in text
    assert '<span class="best" title="the smallest of its column">2.000</span>' in text
    assert '--share:66.7%"><span class="best"' in text and '--share:80.0%"><span class="best"' in text
    words = read(text)
    assert "24 scans of 2 people that nothing was learnt from: p1, p2. Their registrations lie 0.457 mm" in words


def test_one_model_alone_is_not_the_best_of_anything() -> None:
    assert 'class="best"' not in write(study=STUDY | {"models": {"learned": RATES["learned"]}})


def test_what_could_not_be_compared_is_told_with_the_reason_and_templates_only_where_there_were_some() -> None:
    words = read(write(study=STUDY | {"not_compared": {"right hands only": "Too few."}}))
    assert "Not compared: right hands only. Too few." in words and "with a template of their own" not in words
    assert "Pose fitted, with a template of their own" in read(write(study=STUDY | {"own_template": RATES}))


def test_curves_have_a_table_with_a_dash_where_a_number_was_not_measured() -> None:
    curves = {
        "learned": [{"components": 0, "mean_mm": 3.0}, {"components": 5, "mean_mm": 1.0}],
        "right hands only": [{"components": 0, "mean_mm": 4.0}, {"components": 2, "mean_mm": 2.0}],
    }
    rows = [{"components": 1, "mean_mm": 0.75}]
    words = read(write(study=STUDY | {"pose_generalisation": curves, "shape_generalisation": rows}))
    assert "Components 0 2 5 learned 3.000 – 1.000 right hands only 4.000 2.000 –" in words
    assert "Components 1 people left out 0.750" in words
    assert "Generalisation" not in read(write(study=STUDY | {"pose_generalisation": {}, "shape_generalisation": []}))


def test_of_a_long_space_the_first_components_are_drawn() -> None:
    text = write()
    lines = [part.split('"')[0].split() for part in text.split('<polyline points="')[1:]]
    assert [len(line) for line in lines] == [3, MOST_COMPONENTS]


def test_rounds_are_named_in_order_and_the_worst_hand_comes_first() -> None:
    words = read(write())
    assert "first poses round 1 round 2 last poses All registrations 3.000 2.000 1.500 1.250" in words
    assert "not named 2.000 50 a 1.000 40" in words


def test_time_is_that_of_the_training_and_of_the_evaluation_where_there_was_one() -> None:
    assert read(write()).endswith("Part s fit 12.3")
    assert read(write(study=STUDY)).endswith("Part s fit 12.3 evaluation 6.0")
