"""The OpenAPI document as tests read it."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path
from typing import Any

COMMITTED = Path(__file__).resolve().parents[2] / "web" / "src" / "api" / "openapi.json"
"""What the code says: `test_app.py` compares them. To write it anew takes every process of a run three seconds."""


@cache
def read_document() -> dict[str, Any]:
    """Read once for a process; nobody changes it."""
    return json.loads(COMMITTED.read_text())
