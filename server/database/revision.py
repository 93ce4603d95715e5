"""Revisions of things that two people may change: `ETag` out, `If-Match` in."""

from __future__ import annotations

import re
from typing import Annotated

from fastapi import Header

from server.errors import InvalidError, PreconditionMissingError

_TAG = r'^(?:W/)?"([0-9]{1,9})"$'
IfMatch = Annotated[
    str | None, Header(description='The revision that is changed, such as `"3"`.', json_schema_extra={"pattern": _TAG})
]
IfNoneMatch = Annotated[
    str | None, Header(description="`*`: there is none yet.", json_schema_extra={"pattern": r"^\*$"})
]


def write_etag(revision: int) -> str:
    """`ETag` of a revision."""
    return f'"{revision}"'


def read_if_match(if_match: str | None) -> int:
    """The revision that a request means to change; it must say so."""
    if if_match is None:
        raise PreconditionMissingError(
            'Others may change this too: send If-Match with the revision that you change, such as "3".'
        )
    match = re.match(_TAG, if_match.strip())
    if match is None:
        raise InvalidError(f'If-Match is {if_match!r}; needed one revision in quotes, such as "3".')
    return int(match[1])
