"""`python -m server.app.openapi`: the OpenAPI document on stdout, the same bytes for the same code."""

from __future__ import annotations

import json
import sys
from pathlib import Path

from server.app.app import create_app
from server.settings import Settings


def write_document() -> str:
    """The OpenAPI document as JSON text; needs no database and no folder."""
    app = create_app(Settings(data_dir=Path("/nonexistent"), database_url="sqlite://"))
    return json.dumps(app.openapi(), indent=2, sort_keys=True) + "\n"


if __name__ == "__main__":
    sys.stdout.write(write_document())
