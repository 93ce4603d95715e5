"""No stale kernel is ever run: every file that other files' kernels depend on is in the cache's digest."""

import ast
from pathlib import Path

import tracker
from tracker.kernel_cache import SHARED_KERNELS, choose_cache_folder

ROOT = Path(tracker.__file__).parent


def test_every_file_that_kernels_of_other_files_use_is_in_the_digest():
    for path in ROOT.rglob("*.py"):
        tree = ast.parse(path.read_text())
        kernels = [
            node
            for node in ast.walk(tree)
            if isinstance(node, ast.FunctionDef) and any("njit" in ast.unparse(d) for d in node.decorator_list)
        ]
        used = {n.id for kernel in kernels for n in ast.walk(kernel) if isinstance(n, ast.Name)}
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith("tracker."):
                for alias in node.names:
                    if alias.name in used:
                        home = (node.module or "").removeprefix("tracker.").replace(".", "/")
                        file = home + ".py" if (ROOT / (home + ".py")).exists() else home + f"/{home.split('/')[-1]}.py"
                        assert file in SHARED_KERNELS, f"{path} uses {alias.name} of {file} in a kernel"


def test_a_change_of_a_shared_kernel_starts_a_new_folder(tmp_path, monkeypatch):
    before = choose_cache_folder(tmp_path)
    copy = tmp_path / "tracker"
    for name in SHARED_KERNELS:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_bytes((ROOT / name).read_bytes())
    monkeypatch.setattr("tracker.kernel_cache.__file__", str(copy / "kernel_cache.py"))
    assert choose_cache_folder(tmp_path) == before
    (copy / SHARED_KERNELS[0]).write_text("changed")
    assert choose_cache_folder(tmp_path) != before
