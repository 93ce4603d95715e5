"""What the browser app remembers for a person."""

from __future__ import annotations

import json
import uuid
from typing import Any

from sqlalchemy.orm import Session

from server.access.models import Account
from server.errors import ConflictError, InvalidError, TooLargeError

MAX_BYTES = 64_000


def store_preferences(
    session: Session, account_id: uuid.UUID, preferences: dict[str, Any], expected: int | None
) -> Account:
    """Replace the preferences of an account.

    Args:
        expected: The revision that is changed; None replaces whatever there is.
    """
    check_preferences(preferences)
    account = session.get(Account, account_id, with_for_update=True)
    assert account is not None, "accounts are never deleted"
    if expected is not None and expected != account.revision:
        raise ConflictError(
            f"Your account is at revision {account.revision} by now, not {expected}: another tab or somebody else "
            "changed it. Load it again.",
            headers={"ETag": f'"{account.revision}"'},
            theirs=account.preferences,
        )
    account.preferences = preferences
    account.revision += 1
    session.flush()
    return account


def check_preferences(preferences: dict[str, Any]) -> None:
    """Refuse what is too large, or what no database keeps."""
    try:
        text = json.dumps(preferences, ensure_ascii=False, allow_nan=False)
        size = len(text.encode())
    except (ValueError, RecursionError):
        raise InvalidError(
            "The preferences hold a number or a text that JSON does not know (NaN, half a character)."
        ) from None
    if size > MAX_BYTES:
        raise TooLargeError(f"The preferences have {size} bytes; at most {MAX_BYTES} are kept.")
    if "\\u0000" in text.replace("\\\\", ""):
        raise InvalidError("The preferences hold the character U+0000, which cannot be kept. Take it out.")
