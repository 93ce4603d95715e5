"""Passwords: argon2id, a few at a time."""

from __future__ import annotations

import threading
from functools import cache

from pwdlib import PasswordHash
from pwdlib.hashers.argon2 import Argon2Hasher

from server.errors import InvalidError, TooManyTriesError

MIN_LENGTH, MAX_LENGTH = 10, 200

AT_ONCE = 2
"""argon2 takes 64 MB and a core each time: a crowd at the door must not take the studio down."""

PATIENCE = 10.0
"""s that somebody waits for their turn."""

_turns = threading.BoundedSemaphore(AT_ONCE)
_hash = PasswordHash((Argon2Hasher(),))


def check_new_password(password: str, name: str) -> None:
    """Refuse a password that is soon guessed."""
    if not MIN_LENGTH <= len(password) <= MAX_LENGTH:
        raise InvalidError(
            f"The password has {len(password)} characters; needed {MIN_LENGTH} to {MAX_LENGTH}. A few words do."
        )
    plain = password.casefold()
    if len(set(plain)) < 4 or plain.replace(name.casefold(), "", 1) in ("", plain[:2]) or plain in _WELL_KNOWN:
        raise InvalidError("That password is among the first to be guessed. A few words in a row do.")


_WELL_KNOWN = frozenset(
    [
        "1234567890",
        "0123456789",
        "12345678910",
        "qwertyuiop",
        "password12",
        "password123",
        "password1234",
        "passw0rd123",
        "administrator",
        "handloom123",
        "letmein123",
        "iloveyou123",
        "welcome123",
        "changeme123",
        "changemenow",
        "adminadmin",
        "secretsecret",
    ]
)


def hash_password(password: str) -> str:
    """What is kept of a password."""
    with _Turn():
        return _hash.hash(_clean(password))


def verify_password(password: str, password_hash: str | None) -> tuple[bool, str | None]:
    """Whether a password is right, and its new hash when it should be kept in a stronger way by now.

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
            raise TooManyTriesError("Too many people log in at this moment. Try again.", headers={"Retry-After": "5"})

    def __exit__(self, *_: object) -> None:
        _turns.release()
