"""One question for each option, in one order; the required one counts; proposals come from the likeliest sensor."""

from __future__ import annotations

from dataclasses import replace
from itertools import permutations

import pytest

from tracker.capture.import_question import make_question, merge_questions
from tracker.capture.sensor_presets import SensorFit, fit_presets

FIT = fit_presets((512, 424), (900.0,) * 5)
GUESS = next(fit for fit in FIT if fit.is_guess)


def test_a_question_with_a_problem_is_required_unless_it_says_otherwise() -> None:
    assert make_question("fx", "Give it.", "No fx.").is_required
    assert not make_question("fx", "Give it.").is_required
    assert not make_question("fx", "Give it.", "No fx.", is_required=False).is_required
    question = make_question("depth_scale", "Give it.", proposal=0.001)
    assert (question.label, question.kind, question.unit) == ("Depth unit", "number", "m")


def test_an_option_that_nobody_knows_is_a_mistake_of_ours() -> None:
    with pytest.raises(KeyError):
        make_question("colour", "Which?")


def test_whichever_way_they_come_questions_stand_in_one_order() -> None:
    asked = [make_question(field, "?") for field in ("allow_gaps", "fx", "depth_pattern", "fps")]
    orders = {tuple(q.field for q in merge_questions(some, ())) for some in permutations(asked)}
    assert orders == {("depth_pattern", "fx", "fps", "allow_gaps")}


def test_of_two_questions_for_an_option_the_required_one_stays_else_the_first() -> None:
    soft, hard, later = make_question("fx", "soft"), make_question("fx", "hard", "No."), make_question("fx", "x", "y")
    assert merge_questions([soft, hard, later], ()) == (hard,)
    assert merge_questions([hard, soft], ()) == (hard,)
    assert merge_questions([soft, replace(soft, ask="again")], ()) == (soft,)


def test_a_guessed_sensor_proposes_its_values_and_says_so_where_nothing_is_proposed() -> None:
    asked = [make_question("fx", "?", "No."), make_question("cx", "?", "No.", proposal=1.0), make_question("fps", "?")]
    focal, middle, rate = merge_questions(asked, FIT)
    assert focal.proposal == GUESS.values["fx"] and focal.proposed_by == f"typical of {GUESS.label}"
    assert (middle.proposal, middle.proposed_by) == (1.0, "") and "fx" in GUESS.values
    assert rate.proposal == GUESS.values.get("fps")


def test_sensors_that_only_might_be_propose_nothing() -> None:
    doubtful: tuple[SensorFit, ...] = tuple(replace(fit, is_guess=False) for fit in FIT)
    (question,) = merge_questions([make_question("fx", "?")], doubtful)
    assert question.proposal is None
    assert merge_questions([], FIT) == ()
