"""The table of terms and that of presets name what is there."""

from __future__ import annotations

import re

from tests.docs.pages import ROOT
from tracker import PRESETS

OBJECTIVE = (ROOT / "docs" / "objective.md").read_text()
ROWS = re.findall(
    r"^\| [^|]+ \| ((?:`\w+/\w+\.py`(?:, )?)+) \| `(\w+)` \| ([^|]+) \| [^|]+ \|$", OBJECTIVE, re.MULTILINE
)


def test_every_term_has_its_module_its_class_and_its_test() -> None:
    assert len(ROWS) >= 14
    for modules, name, tests in ROWS:
        files = [ROOT / "tracker" / path for path in re.findall(r"`([^`]+)`", modules)]
        assert any(f"class {name}" in path.read_text() for path in files), name
        for path in re.findall(r"`([^`]+)`", tests):
            assert (ROOT / "tests" / "tracker" / path).is_file(), f"{name}: {path}"


def test_every_class_of_a_term_is_in_the_table() -> None:
    found = set()
    for path in (ROOT / "tracker" / "terms").glob("*.py"):
        text = path.read_text()
        found |= {name for name in re.findall(r"^class (\w+)", text, re.MULTILINE) if _is_term(text, name)}
    assert found and found <= {name for _, name, _ in ROWS}


def _is_term(text: str, name: str) -> bool:
    body = text.partition(f"class {name}")[2].partition("\nclass ")[0]
    returned = re.search(r"    def find\(self, posed.*\) -> (.+):$", body, re.MULTILINE)
    return bool(returned) and returned[1] != name and "Protocol" not in body.partition(":")[0]


def test_the_presets_are_those_of_the_page() -> None:
    page = (ROOT / "docs" / "tracking.md").read_text().partition("## Presets")[2].partition("\n## ")[0]
    assert re.findall(r"^\| `(\w+)` \|", page, re.MULTILINE) == [preset.name for preset in PRESETS]
