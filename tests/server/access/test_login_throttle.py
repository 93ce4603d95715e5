"""Who guesses passwords waits; who mistypes their own does not wait for others."""

from __future__ import annotations

import pytest

from server.access import login_throttle
from server.access.login_throttle import LoginThrottle
from server.errors import TooManyTriesError


class Clock:
    def __init__(self) -> None:
        self.now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def throttle(clock: Clock) -> LoginThrottle:
    return LoginThrottle(clock)


def test_the_sixth_try_waits_as_long_as_it_is_told(throttle: LoginThrottle, clock: Clock) -> None:
    for second in range(login_throttle.MAX_BY_NAME_AND_ADDRESS):
        clock.now = float(second)
        throttle.begin("anna", "10.0.0.1")
    with pytest.raises(TooManyTriesError) as told:
        throttle.begin("ANNA", "10.0.0.1")
    wait = int((told.value.headers or {})["Retry-After"])
    assert f"Wait {wait} s" in told.value.detail
    clock.now += wait
    throttle.begin("anna", "10.0.0.1")


def test_who_gets_in_has_a_clean_sheet_but_the_others_do_not(throttle: LoginThrottle) -> None:
    for _ in range(3):
        for _ in range(4):
            throttle.begin("anna", "10.0.0.1")
        throttle.forget("anna", "10.0.0.1")
    for _ in range(login_throttle.MAX_BY_NAME_AND_ADDRESS):
        throttle.begin("ben", "10.0.0.1")
    throttle.forget("anna", "10.0.0.1")
    with pytest.raises(TooManyTriesError):
        throttle.begin("ben", "10.0.0.1")


def test_nobody_locks_somebody_else_out_from_one_address(throttle: LoginThrottle) -> None:
    for _ in range(login_throttle.MAX_BY_NAME_AND_ADDRESS):
        throttle.begin("anna", "10.0.0.66")
    throttle.begin("anna", "10.0.0.1")


def test_many_addresses_together_guess_no_more_than_fifty_times(throttle: LoginThrottle) -> None:
    for number in range(login_throttle.MAX_BY_NAME):
        throttle.begin("anna", f"10.0.1.{number}")
    with pytest.raises(TooManyTriesError):
        throttle.begin("anna", "10.0.2.1")


def test_tries_are_forgotten_after_a_while_and_never_fill_the_memory(throttle: LoginThrottle, clock: Clock) -> None:
    for _ in range(login_throttle.MAX_BY_NAME_AND_ADDRESS):
        throttle.begin("anna", "10.0.0.1")
    clock.now = login_throttle.WINDOW + 1
    throttle.begin("anna", "10.0.0.1")
    for n in range(login_throttle.MAX_BY_ADDRESS - 1):
        throttle.begin(f"made up {n}", "10.0.0.1")
    with pytest.raises(TooManyTriesError):
        throttle.begin("somebody", "10.0.0.1")
    for n in range(2 * login_throttle.MAX_KEYS):
        throttle.begin(f"name {n}", f"10.1.{n // 250}.{n % 250}")
    assert len(throttle._times) <= login_throttle.MAX_KEYS + 3
