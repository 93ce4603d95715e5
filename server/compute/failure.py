"""An error on its way from one process to another."""

from __future__ import annotations

import traceback
from typing import Any


class Failure:
    """Carries an error through pickle. By itself pickle makes an error again from its message alone, which fails for
    errors of ours whose classes take other arguments. SQLAlchemy's errors and OSError know how to be pickled.

    Args:
        error: What was raised.
        note: Where, for the log: the error's traceback stays behind.
    """

    def __init__(self, error: Exception, note: str) -> None:
        self.error, self.note = error, note

    @classmethod
    def of(cls, error: Exception) -> Failure:
        return cls(error, f"In the process that computes:\n{''.join(traceback.format_exception(error))}")

    def __reduce__(self) -> tuple[Any, ...]:
        if type(self.error).__reduce__ is not BaseException.__reduce__:
            return Failure, (self.error, self.note)
        return _rebuild, (type(self.error), self.error.args, self.error.__dict__, self.note)


def _rebuild(kind: type[Exception], args: tuple[Any, ...], state: dict[str, Any], note: str) -> Failure:
    error = kind.__new__(kind, *args)
    error.__dict__.update(state)
    return Failure(error, note)
