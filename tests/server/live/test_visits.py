"""Who has which recording open: known as long as they say so, and forgotten with their page."""

from __future__ import annotations

import uuid

import pytest

from server.live.visits import MOST_VISITS, SILENCE_SECONDS, Visit, Visits

BALL, CUP = uuid.UUID(int=1), uuid.UUID(int=2)
ANNA, BEN = uuid.UUID(int=11), uuid.UUID(int=12)


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def visits(clock: Clock) -> Visits:
    return Visits(clock)


def visit(person: uuid.UUID, frame: int, recording: uuid.UUID = BALL) -> Visit:
    return Visit(recording, person, "anna" if person == ANNA else "ben", "cam0", frame, "right")


def frames(visits: Visits, reader: uuid.UUID, recording: uuid.UUID = BALL) -> list[int]:
    return [other.frame for other in visits.find_others(recording, reader)]


def test_others_are_seen_where_they_moved_last_and_nobody_sees_themselves(visits: Visits) -> None:
    first, second = uuid.uuid4(), uuid.uuid4()
    visits.put(first, visit(ANNA, 1))
    visits.put(second, visit(ANNA, 2))
    assert frames(visits, BEN) == [2] and frames(visits, ANNA) == []
    visits.put(first, visit(ANNA, 3))
    assert frames(visits, BEN) == [3] and frames(visits, BEN, CUP) == []


def test_who_is_silent_for_too_long_has_gone(visits: Visits, clock: Clock) -> None:
    visits.put(uuid.uuid4(), visit(ANNA, 1))
    clock.now = SILENCE_SECONDS
    assert frames(visits, BEN) == [1]
    clock.now += 0.1
    assert frames(visits, BEN) == []


def test_a_visit_ends_with_the_last_stream_of_its_page(visits: Visits) -> None:
    page = uuid.uuid4()
    visits.put(page, visit(ANNA, 1))
    visits.arrive(ANNA, page)
    visits.arrive(ANNA, page)  # the browser connected again before the studio noticed that it had gone
    visits.leave(ANNA, page)
    assert frames(visits, BEN) == [1]
    visits.leave(ANNA, page)
    assert frames(visits, BEN) == []


def test_the_id_of_a_page_means_nothing_in_anybody_elses_name(visits: Visits) -> None:
    page = uuid.uuid4()
    visits.put(page, visit(ANNA, 1))
    visits.put(page, visit(BEN, 5))
    visits.leave(BEN, page)
    assert frames(visits, BEN) == [1] and frames(visits, ANNA) == []


def test_one_person_cannot_fill_the_memory(visits: Visits) -> None:
    for frame in range(3 * MOST_VISITS):
        visits.put(uuid.uuid4(), visit(ANNA, frame))
    assert len(visits._visits) == MOST_VISITS and frames(visits, BEN) == [3 * MOST_VISITS - 1]
