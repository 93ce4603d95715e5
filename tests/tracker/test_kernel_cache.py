"""No stale kernel is ever run: every file that kernels depend on is in the cache's digest."""

from __future__ import annotations

import ast
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

import tracker
from tracker.kernel_cache import choose_cache_folder, find_kernel_files

ROOT = Path(str(tracker.__file__)).parent


def is_kernel(node: ast.AST) -> bool:
    return isinstance(node, ast.FunctionDef) and any("njit" in ast.unparse(one) for one in node.decorator_list)


def find_homes(path: Path) -> Iterator[tuple[str, str]]:
    """Name and file of what the kernels of a file take from other files of the tracker."""
    tree = ast.parse(path.read_text())
    kernels = [node for node in ast.walk(tree) if is_kernel(node)]
    used = {node.id for kernel in kernels for node in ast.walk(kernel) if isinstance(node, ast.Name)}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tracker."):
            home = (node.module or "").removeprefix("tracker.").replace(".", "/")
            for alias in node.names:
                if (alias.asname or alias.name) in used:
                    yield alias.name, f"{home}.py" if (ROOT / f"{home}.py").exists() else f"{home}/__init__.py"


def test_every_kernel_and_all_that_kernels_take_from_other_files_is_in_the_digest():
    found, shared = find_kernel_files(ROOT), 0
    assert len(found) > 40
    for path in ROOT.rglob("*.py"):
        name = path.relative_to(ROOT).as_posix()
        if any(is_kernel(node) for node in ast.walk(ast.parse(path.read_text()))):
            assert name in found
        for used, home in find_homes(path):
            assert home in found, f"{name} uses {used} of {home} in a kernel, a file without kernels"
            shared += 1
    assert shared > 40


@pytest.mark.parametrize(
    ("name", "starts_a_new_folder"),
    [("geometry/se3.py", True), ("terms/normal_equations.py", True), ("cli/track.py", False)],
)
def test_a_change_starts_a_new_folder_where_kernels_depend_on_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, name: str, starts_a_new_folder: bool
):
    before = choose_cache_folder(tmp_path)
    copy = tmp_path / "tracker"
    shutil.copytree(ROOT, copy, ignore=shutil.ignore_patterns("data", "__pycache__"))
    monkeypatch.setattr("tracker.kernel_cache.__file__", str(copy / "kernel_cache.py"))
    assert choose_cache_folder(tmp_path) == before
    (copy / name).write_text((copy / name).read_text() + "\nCHANGED = True\n")
    assert (choose_cache_folder(tmp_path) != before) == starts_a_new_folder
