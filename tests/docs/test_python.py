"""Python that a page shows parses, and what it imports or names is there."""

from __future__ import annotations

import ast
import importlib
import re
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, find_spans, name_of

NAME = re.compile(r"(?:tracker|server|benchmarks)(?:\.[A-Za-z_]\w*)+")


def find_blocks(text: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


def resolve(name: str) -> object:
    """A module, or something of one, by its dotted name."""
    parts = name.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:count]))
        except ModuleNotFoundError:
            continue
        for part in parts[count:]:
            found = getattr(found, part)
        return found
    raise AttributeError(name)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_import_of_a_code_block_works(page: Path) -> None:
    for block in find_blocks(page.read_text()):
        for node in ast.walk(ast.parse(block)):
            if isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    assert resolve(f"{node.module}.{alias.name}") is not None
            elif isinstance(node, ast.Import):
                for alias in node.names:
                    importlib.import_module(alias.name)


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_dotted_name_of_a_page_is_there(page: Path) -> None:
    for span in find_spans(page.read_text()):
        name = NAME.match(span)
        if name and not span.startswith(name[0] + "/"):
            try:
                resolve(name[0])
            except AttributeError:
                pytest.fail(f"`{span}`: there is no {name[0]}")
