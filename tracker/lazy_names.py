"""Names that a package offers and that are loaded when they are first asked for."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any


def offer(package: str) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """`__getattr__` and `__dir__` of a package, which offers what its `if TYPE_CHECKING:` block imports.

    So every name is written once, in imports that type checkers and editors understand. A name must not be that of a
    module of the package: Python would give whichever was loaded last.

    Args:
        package: Its `__name__`.
    """
    offered = sys.modules[package]
    homes = find_homes(Path(str(offered.__file__)))

    def load(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        value = getattr(import_module(homes[name]), name)
        setattr(offered, name, value)
        return value

    return load, lambda: sorted({*vars(offered), *homes})


def find_homes(path: Path) -> dict[str, str]:
    """Each name that the `if TYPE_CHECKING:` block of a file imports, to the module that it comes from."""
    blocks = [node for node in ast.parse(path.read_text(encoding="utf-8")).body if isinstance(node, ast.If)]
    imports = [node for block in blocks for node in block.body if isinstance(node, ast.ImportFrom)]
    return {alias.name: str(node.module) for node in imports for alias in node.names}
