"""What the studio answers when it does not do what it was asked."""

from __future__ import annotations

from typing import Any

import httpx


class StudioRefusal(Exception):
    """An answer that is not a success.

    Attributes:
        status: Of HTTP.
        error: Name of the kind of error.
        detail: What happened and what to do.
        body: The whole body.
    """

    def __init__(self, status: int, body: dict[str, Any]) -> None:
        self.status, self.body = status, body
        self.error, self.detail = str(body.get("error", "Error")), str(body.get("detail", f"status {status}"))
        super().__init__(f"{self.error} ({status}): {self.detail}")


class StaleError(StudioRefusal):
    """Somebody changed it meanwhile. `theirs` is how it is now; nothing was stored."""

    @property
    def theirs(self) -> dict[str, Any]:
        return self.body["theirs"]


class StudioUnreachable(Exception):
    """No answer came, however often it was tried."""


def check(answer: httpx.Response) -> httpx.Response:
    """The answer, if it is a success."""
    if answer.is_success:
        return answer
    try:
        body = answer.json()
    except ValueError:
        body = {}
    kind = StaleError if answer.status_code == 409 and "theirs" in body else StudioRefusal
    raise kind(answer.status_code, body if isinstance(body, dict) else {})
