"""Figures of the program itself: how large, how tangled and how tested each room is.

    python scripts/measure_house.py           # a table of rooms, then what is above a limit
    python scripts/measure_house.py --json

A room is a folder of `tracker` or `server`. Complexity is McCabe's: one more than the places where a function branches.
Compiled kernels are counted apart, since they take arrays one by one and hold their loops themselves.
"""

from __future__ import annotations

import argparse
import ast
import json
import re
from collections import defaultdict
from dataclasses import asdict, dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MOST_PARAMETERS, MOST_COMPLEXITY, FEW_BRANCHES = 10, 15, 3
BRANCHES = (
    *(ast.If, ast.IfExp, ast.For, ast.AsyncFor, ast.While, ast.ExceptHandler),
    *(ast.comprehension, ast.match_case),
)
LISTS = ("functions", "kernels", "unmirrored")
CONSTANT = re.compile(r"_?[A-Z][A-Z0-9_]*$")


@dataclass
class Room:
    """Sums of one folder.

    Attributes:
        name: Such as `tracker/fitting`.
        lines: Of its modules.
        modules: So many.
        test_lines: Of the folder of `tests` with the same name.
        constants: Names in capitals that its modules assign at their top level.
        functions: Place, parameters and complexity of each function that is no kernel.
        kernels: The same of compiled ones.
        unmirrored: Modules that branch and have no test file of their name.
    """

    name: str
    lines: int = 0
    modules: int = 0
    test_lines: int = 0
    constants: int = 0
    functions: list[tuple[str, int, int]] = field(default_factory=list)
    kernels: list[tuple[str, int, int]] = field(default_factory=list)
    unmirrored: list[str] = field(default_factory=list)


def measure(root: Path) -> list[Room]:
    """Every room of `tracker` and `server`, by name."""
    rooms: dict[str, Room] = {}
    for top in ("tracker", "server"):
        for path in sorted((root / top).rglob("*.py")):
            parts = path.relative_to(root).parts
            name = "/".join(parts[:2]) if len(parts) > 2 else top
            add_module(rooms.setdefault(name, Room(name)), path, root)
    for name, room in rooms.items():
        tests = root / "tests" / name
        found = tests.glob("*.py") if "/" not in name else tests.rglob("*.py")
        room.test_lines = sum(count_lines(path) for path in found)
    return [rooms[name] for name in sorted(rooms)]


def add_module(room: Room, path: Path, root: Path) -> None:
    tree = ast.parse(path.read_text())
    mirror = root / "tests" / path.relative_to(root).with_name(f"test_{path.name}")
    if path.name != "__init__.py" and count_branches(tree) >= FEW_BRANCHES and not mirror.exists():
        room.unmirrored.append(str(path.relative_to(root)))
    room.modules += 1
    room.lines += count_lines(path)
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        for target in targets:
            names = target.elts if isinstance(target, ast.Tuple) else [target]
            room.constants += sum(isinstance(one, ast.Name) and bool(CONSTANT.match(one.id)) for one in names)
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            found = f"{path.relative_to(root)}:{node.lineno} {node.name}", count_parameters(node), complexity(node)
            (room.kernels if is_kernel(node) else room.functions).append(found)


def count_lines(path: Path) -> int:
    return len(path.read_text().splitlines())


def count_parameters(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    args = node.args
    named = [one.arg for one in (*args.posonlyargs, *args.args, *args.kwonlyargs)]
    return len([name for name in named if name not in ("self", "cls")]) + bool(args.vararg) + bool(args.kwarg)


def complexity(node: ast.FunctionDef | ast.AsyncFunctionDef) -> int:
    """Without functions inside it, which count by themselves."""
    count, waiting = 1, list(ast.iter_child_nodes(node))
    while waiting:
        each = waiting.pop()
        if isinstance(each, (ast.FunctionDef, ast.AsyncFunctionDef)):
            continue
        count += isinstance(each, BRANCHES)
        count += len(each.values) - 1 if isinstance(each, ast.BoolOp) else 0
        waiting += ast.iter_child_nodes(each)
    return count


def count_branches(tree: ast.AST) -> int:
    """Places where a file branches; with fewer than three it decides too little for a test file of its own."""
    return sum(isinstance(node, BRANCHES) for node in ast.walk(tree))


def is_kernel(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return any("njit" in ast.dump(one) or "kernel" in ast.dump(one) for one in node.decorator_list)


def show(rooms: list[Room], docs: dict[str, int]) -> str:
    rows = ["room                       lines modules  tests constants  parameters  complexity (mean, most)"]
    for room in [*rooms, add_up("tracker", rooms), add_up("server", rooms)]:
        most = max((one[1] for one in room.functions), default=0)
        tangled = [one[2] for one in room.functions] or [1]
        rows.append(
            f"{room.name:25s} {room.lines:6d} {room.modules:7d} {room.test_lines / max(room.lines, 1):6.2f} "
            f"{room.constants:9d} {most:11d} {sum(tangled) / len(tangled):12.2f} {max(tangled):4d}"
        )
    above = [one for room in rooms for one in room.functions if one[1] > MOST_PARAMETERS or one[2] > MOST_COMPLEXITY]
    rows += [
        "",
        f"above {MOST_PARAMETERS} parameters or a complexity of {MOST_COMPLEXITY}, kernels apart: {len(above)}",
    ]
    rows += [f"  {place}: {parameters} parameters, complexity {tangled}" for place, parameters, tangled in above]
    missing = [one for room in rooms for one in room.unmirrored]
    rows += [
        "",
        f"modules with {FEW_BRANCHES} branches or more and no test file of their name: {len(missing)}",
    ]
    rows += [f"  {one}" for one in missing]
    return "\n".join([*rows, "", f"docs: {docs['pages']} pages, {docs['words']} words"])


def add_up(top: str, rooms: list[Room]) -> Room:
    """All rooms of a top-level folder as one."""
    whole: dict[str, list] = defaultdict(list)
    for room in rooms:
        if room.name.split("/")[0] == top:
            for name, value in asdict(room).items():
                whole[name].append(value)
    sums = {name: sum(values) for name, values in whole.items() if name not in ("name", *LISTS)}
    joined = {name: [one for each in whole[name] for one in each] for name in LISTS}
    return Room(f"{top}, all", **sums, **joined)


def measure_docs(root: Path) -> dict[str, int]:
    pages = [*sorted((root / "docs").rglob("*.md")), root / "README.md"]
    return {"pages": len(pages), "words": sum(count_words(page.read_text()) for page in pages)}


def count_words(text: str) -> int:
    """What has a letter or a digit: rules of tables and dashes are no words."""
    return sum(any(letter.isalnum() for letter in word) for word in text.split())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="every figure, for a program")
    rooms, docs = measure(ROOT), measure_docs(ROOT)
    if parser.parse_args().json:
        print(json.dumps({"rooms": [asdict(room) for room in rooms], "docs": docs}, indent=1))
    else:
        print(show(rooms, docs))


if __name__ == "__main__":
    main()
