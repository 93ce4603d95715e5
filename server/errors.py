"""Errors of the API, each knowing its status; the app's one handler gives them all the body `ErrorBody`."""

from __future__ import annotations

from typing import Any, ClassVar

from pydantic import BaseModel, Field


class ErrorBody(BaseModel):
    """The body of every answer that is not a success."""

    error: str = Field(description="Name of the kind of error.", examples=["NotFoundError"])
    detail: str = Field(description="What happened and what to do, for people.")


class StudioError(Exception):
    """Base of every error that the API answers with.

    Args:
        detail: What happened and what to do, for people.
        headers: Of the answer.
        extra: Further members of the body, ready for JSON.
    """

    status_code: ClassVar[int] = 400

    def __init__(self, detail: str, *, headers: dict[str, str] | None = None, **extra: Any) -> None:
        super().__init__(detail)
        self.detail = detail
        self.headers = headers
        self.extra = extra


class NotFoundError(StudioError):
    """There is no such thing, or no longer."""

    status_code = 404


class LoginNeededError(StudioError):
    """Nobody is logged in, or no longer."""

    status_code = 401


class OtherAccountError(LoginNeededError):
    """Somebody else is logged in than when the page was opened."""


class ForbiddenError(StudioError):
    """The request comes from where it must not come."""

    status_code = 403


class ConflictError(StudioError):
    """Somebody else was first."""

    status_code = 409


class InvalidError(StudioError):
    """The request can be read but makes no sense here."""

    status_code = 422


class TooLargeError(StudioError):
    """More was sent than the settings allow."""

    status_code = 413


class TooManyTriesError(StudioError):
    """Wait before trying again; `Retry-After` says how long."""

    status_code = 429


class PreconditionMissingError(StudioError):
    """A change of something that others may change too must say which revision it changes."""

    status_code = 428


def error_responses(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """For a route's `responses`: the one body at each status; 422 is always among them."""
    return {status: {"model": ErrorBody} for status in sorted({422, *statuses})}
