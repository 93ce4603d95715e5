"""Which of the numbers a run reads: where no function that is called names one, a change of it cannot be seen."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import CodeType, FrameType

from benchmarks.constants.numbers import ROOT, Number


@contextmanager
def record_calls() -> Iterator[set[CodeType]]:
    """The code of every Python function that is called meanwhile. Kernels are not seen."""
    called: set[CodeType] = set()

    def note(frame: FrameType, event: str, _: object) -> None:
        if event == "call":
            called.add(frame.f_code)

    sys.setprofile(note)
    try:
        yield called
    finally:
        sys.setprofile(None)


def choose_reached(numbers: list[Number], called: set[CodeType]) -> list[Number]:
    """The numbers that the called functions name, that a module works out at import, or that kernels take in."""
    named = {
        (origin, name)
        for code in called
        if Path(code.co_filename).is_relative_to(ROOT / "tracker") and code.co_name != "<module>"
        for name, origin in read_names(Path(code.co_filename), code.co_names)
    }
    at_import = {pair for path in (ROOT / "tracker").rglob("*.py") for pair in find_names_at_import(path)}
    return [one for one in numbers if one.is_compiled or (one.module, one.name) in named | at_import]


def read_names(path: Path, names: tuple[str, ...]) -> Iterator[tuple[str, str]]:
    """Each name and the module that assigns it, as a function of this file finds them."""
    imported = find_imports(path)
    for name in names:
        origin, own = imported.get(name, (module_of(path), name))
        yield own, origin


@cache
def find_imports(path: Path) -> dict[str, tuple[str, str]]:
    """What a file calls it: the module it comes from and its name there."""
    return {
        alias.asname or alias.name: (node.module, alias.name)
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.ImportFrom) and node.module
        for alias in node.names
    }


def find_names_at_import(path: Path) -> set[tuple[str, str]]:
    """Names that a file reads while it is imported: outside functions, in their defaults and in fields of classes."""
    found: set[str] = set()

    def collect(node: ast.AST) -> None:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            for default in [*node.args.defaults, *(one for one in node.args.kw_defaults if one)]:
                collect(default)
            return
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            found.add(node.id)
        for child in ast.iter_child_nodes(node):
            collect(child)

    collect(ast.parse(path.read_text()))
    return {(origin, name) for name, origin in read_names(path, tuple(found))}


def module_of(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)
