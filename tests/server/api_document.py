"""The OpenAPI document as tests read it."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from server.app.openapi import write_document


@cache
def read_document() -> dict[str, Any]:
    """What the code says, written once for a process: it takes more than a second. Nobody changes it."""
    return json.loads(write_document())
