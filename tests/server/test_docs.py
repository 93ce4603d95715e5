"""The documentation says what the code does."""

from __future__ import annotations

import re
from pathlib import Path

from tests.server.api_document import read_document

PAGE = Path(__file__).parents[2] / "docs" / "api.md"


def test_every_request_of_the_api_is_documented_and_no_other() -> None:
    offered = {
        f"{method.upper()} {path.removeprefix('/api/v1')}"
        for path, item in read_document()["paths"].items()
        for method in item
    }
    documented = re.findall(r"^\| `([A-Z]+ /\S*)` \| .+ \|$", PAGE.read_text(), re.MULTILINE)
    assert len(documented) == len(set(documented))
    assert set(documented) == offered
