"""The numbers that modules of the tracker name at their top level, and how one of them is changed for a run."""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, PathFinder, SourceFileLoader
from pathlib import Path
from types import CodeType, ModuleType

ROOT = Path(__file__).resolve().parents[2]

ROOMS = ("observation", "landmarks", "fitting", "search", "tracking", "terms")
"""The folders of the tracker whose code follows hands; the others read, write, calibrate, register, train or render."""

NAME = re.compile(r"[A-Z][A-Z0-9_]*$")


@dataclass(frozen=True)
class Number:
    """One of the tracker's numbers.

    Attributes:
        module: That assigns it, such as `tracker.fitting.quality`.
        name: In capitals.
        value: As it stands there.
        is_compiled: Its module holds kernels, which take in the number when they are compiled.
    """

    module: str
    name: str
    value: int | float
    is_compiled: bool

    def times(self, factor: float) -> int | float:
        """The number a factor larger; a count stays whole and at least 1."""
        return max(1, round(self.value * factor)) if isinstance(self.value, int) else self.value * factor


def list_numbers(rooms: Sequence[str] = ROOMS, root: Path = ROOT) -> list[Number]:
    """The numbers of these rooms, in the order of their files. Those that are worked out from others are not listed."""
    found = []
    for room in rooms:
        for path in sorted((root / "tracker" / room).rglob("*.py")):
            text = path.read_text()
            module = ".".join(path.relative_to(root).with_suffix("").parts)
            found += [Number(module, name, value, "njit" in text) for name, value in find_numbers(ast.parse(text))]
    return found


def find_numbers(tree: ast.Module) -> Iterator[tuple[str, int | float]]:
    for target, value in list_assignments(tree):
        number = literal_number(value)
        if number is not None and NAME.match(target.id):
            yield target.id, number


def list_assignments(tree: ast.Module) -> Iterator[tuple[ast.Name, ast.expr]]:
    """Each name that is assigned at the top, and what; those of a tuple one by one."""
    for node in tree.body:
        if not isinstance(node, ast.Assign):
            continue
        target, value = node.targets[0], node.value
        if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
            yield from zip(target.elts, value.elts, strict=True)  # type: ignore[misc]
        elif isinstance(target, ast.Name):
            yield target, value


def literal_number(node: ast.expr) -> int | float | None:
    try:
        value = ast.literal_eval(node)
    except ValueError:
        return None
    return value if isinstance(value, (int, float)) and not isinstance(value, bool) else None


@dataclass(frozen=True)
class ChangedNumber(MetaPathFinder):
    """Has Python import one module with another number in it. Put it into `sys.meta_path` before the module is needed.

    The text is changed and not the module, so what is worked out from the number at import, a default of a function
    say, changes with it.
    """

    module: str
    name: str
    value: int | float

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        if fullname != self.module:
            return None
        spec = PathFinder.find_spec(fullname, path)
        if spec is not None and spec.origin is not None:
            spec.loader = ChangedSource(fullname, spec.origin, self.name, self.value)
        return spec

    def install(self) -> None:
        """Raises: RuntimeError: The module is imported already."""
        if self.module in sys.modules:
            raise RuntimeError(f"{self.module} is imported already; change its number before.")
        sys.meta_path.insert(0, self)


class ChangedSource(SourceFileLoader):
    """Compiles a module's text with another value of one name, past the compiled file that is kept."""

    def __init__(self, fullname: str, path: str, name: str, value: int | float) -> None:
        super().__init__(fullname, path)
        self.changed, self.value = name, value

    def get_code(self, fullname: str) -> CodeType:
        tree = ast.parse(self.get_data(self.path))
        places = [value for target, value in list_assignments(tree) if target.id == self.changed]
        if not places:
            raise ImportError(f"{self.path} assigns no number to {self.changed}.")
        ReplacedNodes({id(place): ast.Constant(self.value) for place in places}).visit(tree)
        return compile(ast.fix_missing_locations(tree), self.path, "exec")


class ReplacedNodes(ast.NodeTransformer):
    """Puts other nodes where some are, which are told by their identity."""

    def __init__(self, others: dict[int, ast.expr]) -> None:
        self.others = others

    def visit(self, node: ast.AST) -> ast.AST:
        return self.others.get(id(node)) or self.generic_visit(node)
