"""Passwords: argon2id, a few at a time."""

from __future__ import annotations

import threading
from functools import cache

from pwdlib import PasswordHash
from pwdlib.hashers.argon2 import Argon2Hasher

from server.errors import InvalidError, TooManyTriesError

MIN_LENGTH, MAX_LENGTH = 10, 200

WELL_KNOWN = ("password", "passwort", "passw0rd", "qwerty", "1234567890", "123456", "handloom", "letmein", "admin")
"""Words that are tried first; they count for nothing."""

AT_ONCE = 2
"""argon2 takes 64 MB and a core each time: a crowd that logs in at once must not take the studio down."""

PATIENCE = 10.0
"""s that somebody waits for their turn."""

_turns = threading.BoundedSemaphore(AT_ONCE)
_hash = PasswordHash((Argon2Hasher(),))


def check_new_password(password: str, name: str) -> None:
    """Refuse a password that is soon guessed."""
    if not MIN_LENGTH <= len(password) <= MAX_LENGTH:
        raise InvalidError(
            f"The password has {len(password)} characters; needed {MIN_LENGTH} to {MAX_LENGTH}. Use several words."
        )
    plain = password.casefold()
    rest = plain.replace(name.casefold(), "")
    for word in WELL_KNOWN:
        rest = rest.replace(word, "")
    if len(set(rest)) < 4:
        raise InvalidError("That password is easy to guess. Use several words in a row.")


def hash_password(password: str) -> str:
    """What is kept of a password."""
    with _Turn():
        return _hash.hash(_clean(password))


def verify_password(password: str, password_hash: str | None) -> tuple[bool, str | None]:
    """Whether a password is right, and its new hash when it should be stored with stronger settings.

    Takes as long for an account that has no password, or for none at all: nobody learns who has an account here.
    """
    with _Turn():
        if password_hash is None or len(password) > MAX_LENGTH:
            _hash.verify(_clean(password[:MAX_LENGTH]), _find_decoy())
            return False, None
        return _hash.verify_and_update(_clean(password), password_hash)


def _clean(password: str) -> bytes:
    return password.encode(errors="surrogatepass")


@cache
def _find_decoy() -> str:
    return _hash.hash("nobody has this password")


class _Turn:
    """`with`: one of the few that compute at once."""

    def __enter__(self) -> None:
        if not _turns.acquire(timeout=PATIENCE):
            raise TooManyTriesError(
                "Too many people are logging in. Try again in a few seconds.", headers={"Retry-After": "5"}
            )

    def __exit__(self, *_: object) -> None:
        _turns.release()
