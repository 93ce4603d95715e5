"""A decision as the API takes it: known reasons once each, a note of a length, and nothing beside."""

from __future__ import annotations

import uuid
from typing import Any

import pytest
from pydantic import ValidationError

from server.registrations.decision_schemas import REASONS, DecisionMake, SecondReviewAsk


def make(**fields: Any) -> DecisionMake:
    return DecisionMake.model_validate({"decision": "reject", "operation_id": str(uuid.uuid4())} | fields)


def refuse(**fields: Any) -> str:
    """What is said of a decision that cannot be taken."""
    with pytest.raises(ValidationError) as fault:
        make(**fields)
    [error] = fault.value.errors()
    return f"{'.'.join(map(str, error['loc']))}: {error['msg']}"


def test_a_decision_needs_no_reason_no_note_and_no_time() -> None:
    made = make()
    assert (made.reasons, made.note, made.seconds) == ([], "", None)


def test_the_keys_one_to_nine_give_every_reason() -> None:
    assert len(REASONS) == 9 and list(REASONS)[-1] == "other"
    assert make(reasons=list(REASONS)).reasons == list(REASONS)


def test_a_reason_given_twice_counts_once_where_it_came_first() -> None:
    assert make(reasons=["slid", "other", "slid"]).reasons == ["slid", "other"]


def test_an_unknown_reason_is_named_with_those_that_there_are() -> None:
    told = refuse(reasons=["slid", "ugly"])
    assert told.startswith("reasons: ") and "no reason is called 'ugly'" in told
    assert all(reason in told for reason in REASONS)


def test_more_reasons_than_keys_are_refused_though_they_repeat() -> None:
    assert refuse(reasons=["slid"] * 10).startswith("reasons: List should have at most 9 items")


def test_a_note_loses_the_space_around_it_and_keeps_what_is_inside() -> None:
    assert make(note="  thumb\n off \t").note == "thumb\n off"
    assert make(note="x" * 2000).note == "x" * 2000


@pytest.mark.parametrize(("note", "told"), [("x" * 2001, "at most 2000"), ("a\x00b", "the character NUL")])
def test_a_note_that_cannot_be_stored_is_refused(note: str, told: str) -> None:
    assert told in refuse(note=note)


@pytest.mark.parametrize("seconds", [0, 86400, 1.5])
def test_a_look_takes_from_nothing_to_a_day(seconds: float) -> None:
    assert make(seconds=seconds).seconds == seconds


@pytest.mark.parametrize("seconds", [-0.1, 86400.5, float("nan"), True, "3"])
def test_a_time_that_is_none_is_refused(seconds: Any) -> None:
    assert refuse(seconds=seconds).startswith("seconds")


@pytest.mark.parametrize(
    ("fields", "place"),
    [({"decision": "undo"}, "decision"), ({"operation_id": "1"}, "operation_id"), ({"stands": True}, "stands")],
)
def test_what_is_no_decision_is_refused_at_its_place(fields: dict[str, Any], place: str) -> None:
    assert refuse(**fields).startswith(place)


@pytest.mark.parametrize("share", [0, 1.01])
def test_a_second_review_is_asked_for_a_share_of_more_than_nothing_and_at_most_all(share: float) -> None:
    with pytest.raises(ValidationError, match="share"):
        SecondReviewAsk(share=share)
    assert SecondReviewAsk(share=1).share == 1.0 and not SecondReviewAsk().only_decided
