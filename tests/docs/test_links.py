"""Every link of the documentation leads somewhere."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.docs.pages import PAGES, RESULTS, ROOT, find_anchors, find_links, find_spans, name_of

SOURCE = re.compile(r"(?:tracker|server|web|tests|scripts|benchmarks|examples|migrations|docker|docs)/[\w./-]*\w")
"""A path that a page names between backticks."""


KINDS = {".py", ".ts", ".tsx", ".yaml"}
"""Endings of files of the program."""


@pytest.mark.parametrize("page", [*PAGES, *RESULTS], ids=name_of)
def test_every_link_leads_to_a_file_and_to_a_heading_in_it(page: Path) -> None:
    for link in find_links(page.read_text()):
        if link.startswith(("http://", "https://")):
            continue
        path, _, anchor = link.partition("#")
        target = (page.parent / path).resolve() if path else page
        assert target.is_relative_to(ROOT), f"{link} leads out of the repository"
        assert target.exists(), f"{link}: there is no such file"
        if anchor:
            assert anchor in find_anchors(target.read_text()), f"{link}: the page has no such heading"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_file_that_a_page_names_is_there(page: Path) -> None:
    for span in find_spans(page.read_text()):
        path = span.split("::")[0].rstrip("/")
        if SOURCE.fullmatch(path) and Path(path).suffix in ("", ".py", ".ts", ".tsx", ".md", ".npz", ".json", ".toml"):
            assert (ROOT / path).exists(), f"`{span}`: there is no such file"


def test_every_page_that_the_program_names_is_there() -> None:
    folders = ("tracker", "server", "web/src", "benchmarks", "scripts", "docker", "examples", "tests")
    files = [
        path for folder in folders for path in (ROOT / folder).rglob("*") if path.is_file() and path.suffix in KINDS
    ]
    named = {
        (path, page)
        for path in [*files, ROOT / "Makefile"]
        for page in re.findall(r"\bdocs/[\w/]+\.md", path.read_text())
        if not (ROOT / page).exists()
    }
    assert {f"{name_of(path)}: {page}" for path, page in named} == set()


def test_every_picture_of_the_documentation_is_shown() -> None:
    shown = {
        (page.parent / link.partition("#")[0]).resolve()
        for page in [*PAGES, *RESULTS]
        for link in find_links(page.read_text())
    }
    pictures = [path for path in (ROOT / "docs" / "pictures").iterdir() if path.is_file()]
    assert [path.name for path in pictures if path not in shown] == []
