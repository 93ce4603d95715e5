"""Values of label files from outside: numbers in bulk, JSON of several files."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.capture.document import Node, parse_json
from tracker.errors import AnnotationError

Array = npt.NDArray[np.float64]
MAX_ENTRIES = 1_000_000
"""Images, annotations or rows of one file of labels; a bound of ours, far above any data set that is known to us."""
MAX_PIXEL = 1e6
"""px; a bound of ours."""
MAX_LENGTH_M = 1e4
"""m; a bound of ours."""


def read_numbers(node: Node, shape: tuple[int, ...], bound: float) -> Array:
    """Finite numbers of at most `bound` in nested lists of this shape, or in one flat list of as many."""
    count = int(np.prod(shape))
    flat = _flatten(node, node.value, len(shape))
    if len(flat) != count:
        node.fail(f"{' x '.join(map(str, shape))} numbers")
    if not all(type(value) in (int, float) and -bound <= value <= bound for value in flat):
        node.fail(f"numbers from {-bound:g} to {bound:g}")
    return np.array(flat, dtype=np.float64).reshape(shape)


def _flatten(node: Node, value: Any, depth: int) -> list[Any]:
    if not isinstance(value, list):
        node.fail("a list [...]")
    if depth and value and isinstance(value[0], list):
        if len(value) > 1000:
            node.fail("a shorter list")
        return [number for item in value for number in _flatten(node, item, depth - 1)]
    return value


def find_json(files: dict[str, bytes], ending: str) -> Node:
    """The one file of this ending, parsed."""
    found = [name for name in files if name.split("/")[-1].endswith(ending)]
    if len(found) != 1:
        names = ", ".join(sorted(files)[:5]) or "no files"
        raise AnnotationError(f"Needed one file ...{ending}; found {len(found)} among {names}.")
    return parse_json(files[found[0]], found[0], AnnotationError)


def write_json(document: Any) -> bytes:
    """Compact JSON, the same bytes for the same content."""
    return (json.dumps(document, separators=(",", ":"), ensure_ascii=False, allow_nan=False) + "\n").encode()
