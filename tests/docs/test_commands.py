"""Every command of the documentation is one that the program takes."""

from __future__ import annotations

import argparse
import re
import shlex
from pathlib import Path

import pytest

from server.cli.main import make_parser
from tests.docs.pages import PAGES, ROOT, find_code, find_spans, name_of

HANDLOOM = re.compile(r"^(?:[A-Z_]+=\S+ )*(?:\S*/)?handloom (?=[a-z])")
PYTHON = re.compile(r"^(?:[A-Z_]+=\S+ )*(?:\S*/)?python3? (-m )?((?:benchmarks|scripts)[\w./]*)")


PLACEHOLDERS = {"N": "2", "M": "0.5", "MM": "0.5", "X": "0.5", "A:B": "0:10", "WxH": "320x240"}
"""What a page writes for numbers, and a number of that kind."""


def words_of(line: str) -> list[str]:
    """The arguments of a command: what may be left out is given, of alternatives the first, dots left out."""
    plain = re.sub(r"(?<=\s)\[|\](?=[\s\]]|$)", "", line)
    words = shlex.split(plain, comments=True)
    first = [word.split("|")[0] for word in words if word != "..."]
    return [PLACEHOLDERS.get(word, word) for word in first]


def commands_of(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def options_of(parser: argparse.ArgumentParser) -> set[str]:
    """The options of a command and of those below it."""
    own = {option for action in parser._actions for option in action.option_strings}
    return own.union(*(options_of(below) for below in commands_of(parser).values()))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_whole_command_is_understood(page: Path, capsys: pytest.CaptureFixture[str]) -> None:
    parser = make_parser()
    for line in find_code(page.read_text()):
        begin = HANDLOOM.match(line)
        if begin:
            try:
                parser.parse_args(words_of(line[begin.end() :]))
            except SystemExit:
                pytest.fail(f"{line}\n{capsys.readouterr().err}")


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_command_within_a_sentence_has_such_options(page: Path) -> None:
    commands = commands_of(make_parser())
    for span in find_spans(page.read_text()):
        begin = HANDLOOM.match(span)
        if begin:
            words = words_of(span[begin.end() :])
            assert words[0] in commands, f"`{span}`: there is no command {words[0]}"
            given = {word.partition("=")[0] for word in words if word.startswith("--")}
            assert given <= options_of(commands[words[0]]) | {"--json"}, span


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_script_is_there_and_knows_its_options(page: Path) -> None:
    text = page.read_text()
    for line in [*find_code(text), *find_spans(text)]:
        begin = PYTHON.match(line)
        if not begin:
            continue
        path = ROOT / (begin[2].replace(".", "/") if begin[1] else begin[2])
        files = sorted(path.glob("*.py")) if path.is_dir() else [path.with_suffix(".py")]
        assert files and all(file.is_file() for file in files), f"{line}: there is no such script"
        source = "".join(file.read_text() for file in files)
        for word in words_of(line[begin.end() :]):
            if word.startswith("--"):
                assert f'"{word.partition("=")[0]}"' in source, f"{line}: the script has no option {word}"


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_target_of_make_is_there(page: Path) -> None:
    text, makefile = page.read_text(), (ROOT / "Makefile").read_text()
    for line in [*find_code(text), *find_spans(text)]:
        for target in re.findall(r"^make (?:-k )?([a-z][a-z-]*)", line):
            assert re.search(rf"^{target}(?: [\w-]+)*:", makefile, re.MULTILINE), f"{line}: make has no {target}"
