"""Operations whose place another one has taken: they answer for one version more, and say so."""

from __future__ import annotations

from datetime import UTC, datetime
from typing import Any
from urllib.parse import quote

from fastapi import Depends, Request, Response

SINCE = datetime(2026, 11, 25, tzinfo=UTC)
"""When the operations of version 1 that are deprecated became so."""


def deprecated(successor: str) -> dict[str, Any]:
    """Arguments of a route that is deprecated: the API's document says so, and its answers name the successor.

    The headers are those of RFC 9745 (`Deprecation`) and RFC 8288 (`Link`, `successor-version`).

    Args:
        successor: Path of the operation to use instead, under `/api/v1`; it may name parameters of the route.
    """

    async def name_successor(request: Request, response: Response) -> None:
        names = {name: quote(str(value), safe="") for name, value in request.path_params.items()}
        path = f"/api/v1{successor.format(**names)}"
        response.headers["Deprecation"] = f"@{int(SINCE.timestamp())}"
        response.headers["Link"] = f'<{path}>; rel="successor-version"'

    return {
        "deprecated": True,
        "dependencies": [Depends(name_successor)],
        "openapi_extra": {"x-successor": successor},
    }
