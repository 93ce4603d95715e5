"""The pages of the documentation, and what tests look for in them."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
RESULTS = sorted((ROOT / "benchmarks" / "results").rglob("*.md"))
"""Written by scripts, or copied from what they print; their links are tested, too."""


def name_of(page: Path) -> str:
    return page.relative_to(ROOT).as_posix()


def find_code(text: str) -> list[str]:
    """Lines of code blocks: indented by four spaces, or between fences. A line that ends in a backslash goes on."""
    found: list[str] = []
    lines, is_fenced = text.split("\n"), False
    for line in lines:
        if line.startswith("```"):
            is_fenced = not is_fenced
        elif is_fenced or line.startswith("    "):
            found.append(str(line.strip()))
    return "\n".join(found).replace("\\\n", " ").split("\n")


def find_spans(text: str) -> list[str]:
    """What stands between backticks within a line."""
    return re.findall(r"`([^`\n]+)`", text)


def find_links(text: str) -> list[str]:
    """Targets of links and pictures, code left out."""
    prose = re.sub(r"```.*?```|`[^`\n]*`", "", text, flags=re.DOTALL)
    prose = "\n".join(line for line in prose.split("\n") if not line.startswith("    "))
    return re.findall(r"\]\(([^)\s]+)\)", prose)


def find_anchors(text: str) -> set[str]:
    """The anchors that GitHub gives to headings."""
    headings = re.findall(r"^#+ (.+)$", re.sub(r"```.*?```", "", text, flags=re.DOTALL), re.MULTILINE)
    plain = [re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower() for heading in headings]
    return {re.sub(r"[^\w\- ]", "", heading).strip().replace(" ", "-") for heading in plain}
