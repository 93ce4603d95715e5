"""Passwords: which are refused, and that checking one tells nothing but whether it is right."""

from __future__ import annotations

import threading

import pytest

from server.access import passwords
from server.access.passwords import check_new_password, hash_password, verify_password
from server.errors import InvalidError, TooManyTriesError

GOOD = "four words in a row"


def test_a_few_words_do_and_are_kept_as_an_argon2id_hash() -> None:
    check_new_password(GOOD, "anna")
    kept = hash_password(GOOD)
    assert kept.startswith("$argon2id$") and GOOD not in kept
    assert verify_password(GOOD, kept) == (True, None)
    assert verify_password(GOOD + "!", kept)[0] is False
    assert hash_password(GOOD) != kept, "each has a salt of its own"


@pytest.mark.parametrize("password", ["short", "x" * 201])
def test_too_short_or_too_long_is_refused_with_the_length_that_is_needed(password: str) -> None:
    with pytest.raises(InvalidError, match=rf"has {len(password)} characters; needed 10 to 200"):
        check_new_password(password, "anna")


@pytest.mark.parametrize(
    "password", ["password1234567890", "PassWordPassWord", "annaannaannaanna", "aaaaaaaaaaaa", "handloomanna12"]
)
def test_what_is_guessed_first_is_refused(password: str) -> None:
    with pytest.raises(InvalidError, match="easy to guess"):
        check_new_password(password, "Anna")


def test_an_account_without_a_password_is_opened_by_none() -> None:
    assert verify_password("nobody has this password", None) == (False, None)
    assert verify_password("x" * 10_000, hash_password(GOOD)) == (False, None)


def test_half_a_character_is_a_password_as_any_other() -> None:
    odd = "\ud800 four words in a row"
    assert verify_password(odd, hash_password(odd))[0] is True


def test_a_crowd_waits_its_turn_and_is_sent_away_when_it_takes_too_long(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(passwords, "_turns", threading.BoundedSemaphore(1))
    monkeypatch.setattr(passwords, "PATIENCE", 0.01)
    with passwords._Turn(), pytest.raises(TooManyTriesError, match="Too many people are logging in"):
        hash_password(GOOD)
    assert verify_password(GOOD, hash_password(GOOD))[0], "who waited in vain takes no turn"
