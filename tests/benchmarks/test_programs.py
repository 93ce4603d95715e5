"""Every benchmark starts where the pages say: as a module, from the project's folder."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
MODULES = [".".join(path.relative_to(ROOT).with_suffix("").parts) for path in sorted(ROOT.glob("benchmarks/**/*.py"))]


@pytest.mark.slow
def test_every_benchmark_finds_all_that_it_imports() -> None:
    """In a process of its own, because benchmarks set the number of threads when they are imported."""
    program = f"import importlib\nfor name in {MODULES!r}:\n    assert importlib.import_module(name).__doc__, name"
    done = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
