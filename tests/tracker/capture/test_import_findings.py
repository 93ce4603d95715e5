"""Findings keep the order of what was found; a question stands beside the sentence that it mends."""

from __future__ import annotations

import pytest

from tracker.capture.import_findings import Findings, show_first


def test_a_refusal_without_an_option_asks_nothing_and_one_with_an_option_requires_an_answer() -> None:
    found = Findings()
    found.refuse("It is damaged.")
    found.refuse("The unit is not known.", "depth_scale")
    found.refuse("fx is 1 px.", "fx", "Needed more.", proposal=60.0)
    assert found.problems == ["It is damaged.", "The unit is not known.", "fx is 1 px."]
    unit, focal = found.questions
    assert (unit.field, unit.ask, unit.problem) == ("depth_scale", "The unit is not known.", "The unit is not known.")
    assert (focal.ask, focal.problem, focal.proposal) == ("Needed more.", "fx is 1 px.", 60.0)
    assert unit.is_required and focal.is_required and found.warnings == []


def test_a_question_alone_may_stay_unanswered_and_refuses_nothing() -> None:
    found = Findings()
    found.ask("fps", "30 are assumed.")
    assert found.problems == found.warnings == [] and not found.questions[0].is_required


@pytest.mark.parametrize("is_allowed", [None, False, True])
def test_missing_frames_are_an_oddity_only_where_somebody_allowed_them(is_allowed: bool | None) -> None:
    found = Findings()
    found.miss("Gap.", is_allowed, allowed="Neighbours.", refused="Add them.", ask="Allow?")
    if is_allowed:
        assert found == Findings(warnings=["Gap. Neighbours."])
    else:
        assert found.problems == ["Gap. Add them."] and found.warnings == []
        assert [(q.field, q.ask, q.problem) for q in found.questions] == [
            ("allow_gaps", "Gap. Allow?", "Gap. Add them.")
        ]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ((), []),
        (("a",), ["1 other file is left out: a."]),
        (("a", "b", "c"), ["3 other files are left out: a, b, c."]),
        (("a", "b", "c", "d"), ["4 other files are left out: a, b, c, and 1 more."]),
    ],
)
def test_files_that_are_left_out_are_counted_and_three_named(names: tuple[str, ...], said: list[str]) -> None:
    found = Findings()
    found.leave_out(names)
    assert found.warnings == said and found.problems == []


def test_names_are_shown_up_to_a_number_and_the_others_are_counted() -> None:
    assert show_first(["a", "b"], 2) == "a, b" and show_first(["a", "b", "c"], 2, "; ") == "a; b; and 1 more"
    assert show_first([], 3) == ""


def test_two_findings_share_nothing() -> None:
    first, second = Findings(), Findings()
    first.warn("Odd.")
    assert second.warnings == []
