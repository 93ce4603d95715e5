"""Every threat that docs/operating.md lists names tests, and those tests are there."""

from __future__ import annotations

import re
from pathlib import Path

TESTS = Path(__file__).parents[2]
PAGE = TESTS.parent / "docs" / "operating.md"


def test_every_threat_has_tests_that_are_there() -> None:
    rows = re.findall(r"^\| (.+) \| (.+) \| (.+) \|$", PAGE.read_text().partition("## Threats")[2], re.MULTILINE)[1:]
    assert len(rows) >= 15
    for threat, _, cell in rows:
        file, names = "", re.findall(r"`([^`]+)`", cell)
        assert names, threat
        for name in names:
            named, _, test = name.rpartition(": ")
            file = named or file
            assert f"def {test}(" in (TESTS / file).read_text(), f"{threat}: {file} has no {test}"
