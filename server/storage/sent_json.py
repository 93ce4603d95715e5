"""JSON that comes with uploads: the field `options` of a form, and lists that lie beside files."""

from __future__ import annotations

import json
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from pydantic import ValidationError

from server.errors import InvalidError, StudioError


@contextmanager
def reading_json(what: str, needed: str) -> Iterator[None]:
    """The one guard of such JSON: whatever a parser throws becomes an `InvalidError`, as `reading` does for files.

    Args:
        what: What is read, such as "The field `options`".
        needed: What it must be.
    """
    try:
        yield
    except StudioError:
        raise
    except ValidationError as fault:
        first = fault.errors()[0]
        place = ".".join(map(str, first["loc"]))
        got = f" (got {str(first['input'])[:80]!r})" if place else ""
        raise InvalidError(
            f"{what} is wrong: {f'{place}: ' if place else ''}{first['msg']}{got}; needed {needed}."
        ) from None
    except Exception as fault:  # of every kind: what was sent is to blame, whatever its parser trips over
        raise InvalidError(
            f"{what} cannot be read ({type(fault).__name__}: {str(fault)[:120]}); needed {needed}."
        ) from None


def read_options(text: str) -> dict[str, Any]:
    """The field `options` of a form: a JSON object, or nothing."""
    if not text.strip():
        return {}
    with reading_json("The field `options`", "a JSON object"):
        options = json.loads(text)
    if not isinstance(options, dict):
        raise InvalidError(f"The field `options` is {text[:80]!r}; needed a JSON object.")
    return options
