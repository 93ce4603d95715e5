"""Detectors on disk: an .npz archive of plain arrays, read without pickle."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.atomic_file import write_atomically
from tracker.detection.channels import CHANNELS
from tracker.detection.forest import MODES, WHATS, Forest
from tracker.detection.levels import PATCH
from tracker.errors import ModelFileError, reads
from tracker.model.npz_arrays import NpzFields, read_npz_arrays

FORMAT = "handloom fingertip detector 1"
MAX_TREES = 1000
"""A bound of ours."""
MAX_FILE_BYTES = 32 * 2**20
"""Ten times what the paper's options make."""

NEEDED = "a fingertip detector as `handloom train-detector` writes it (.npz)"


def save_forest(forest: Forest, path: Path) -> None:
    """Write a detector, whole or not at all; `load_forest` gives it back to the last bit."""
    arrays = {
        "format": np.array([FORMAT]),
        "kind": np.array([forest.kind]),
        "what": np.array([forest.what]),
        "sizes": np.array([forest.pixel_size, forest.box_size, forest.confidence_scale]),
        "nodes": forest.nodes.astype(np.int64),
        "node_starts": forest.node_starts.astype(np.int64),
        "leaf_starts": forest.leaf_starts.astype(np.int64),
        "probability": forest.probability.astype(np.float64),
        "votes": forest.votes.astype(np.float64),
    }
    data = io.BytesIO()
    np.savez_compressed(data, allow_pickle=False, **arrays)
    write_atomically(Path(path), data.getvalue())


@reads(ModelFileError, NEEDED)
def load_forest(path: Path) -> Forest:
    """A detector from a file.

    Raises:
        ModelFileError: It is no detector, or a damaged one.
    """
    path = Path(path)
    _check_kind(path)
    fields = NpzFields(path, read_npz_arrays(path))
    if "format" not in fields:
        raise ModelFileError(path, "an archive of something else", NEEDED)
    if fields.texts("format", 1) != (FORMAT,):
        raise ModelFileError(path, f"the format {fields.texts('format', 1)[0][:60]!r}", NEEDED)
    kind = fields.texts("kind", 1)[0]
    if kind not in ("depth", "color"):
        raise ModelFileError(path, f"the kind {kind[:60]!r}", "'depth' or 'color'")
    what = fields.texts("what", 1)[0] if "what" in fields else "fingertips"  # files of before nails have none
    if what not in WHATS:
        raise ModelFileError(path, f"a detector of {what[:60]!r}", " or ".join(WHATS))
    sizes = fields.floats("sizes", (3,), 1e6)
    if not (5e-4 <= sizes[0] <= 0.02 and 1e-3 <= sizes[1] <= 1.0 and sizes[2] > 0.0):
        raise ModelFileError(path, f"sizes {sizes.tolist()}", "a pixel, a box, m, and a scale of confidences")
    nodes = fields.integers("nodes", (-1, 5), -(2**15), 2**15)
    node_starts = _starts(fields, "node_starts", len(nodes))
    probability = fields.floats("probability", (-1,), 1.0)
    leaf_starts = _starts(fields, "leaf_starts", len(probability))
    if len(node_starts) != len(leaf_starts):
        raise ModelFileError(path, f"{len(node_starts) - 1} and {len(leaf_starts) - 1} trees", "the same number")
    votes = fields.floats("votes", (len(probability), MODES, 4), 1e4)
    if (probability < 0.0).any() or (votes[:, :, 3] < 0.0).any() or (votes[:, :, 3] > 1.0).any():
        raise ModelFileError(path, "shares beyond 0 to 1", "shares from 0 to 1")
    for tree in range(len(node_starts) - 1):
        own = nodes[node_starts[tree] : node_starts[tree + 1]]
        _check_tree(path, tree, own, int(leaf_starts[tree + 1] - leaf_starts[tree]))
    return Forest(
        kind,
        float(sizes[0]),
        float(sizes[1]),
        float(sizes[2]),
        nodes.astype(np.int16),
        node_starts.astype(np.int32),
        leaf_starts.astype(np.int32),
        probability.astype(np.float32),
        votes.astype(np.float32),
        what,
    )


def _check_kind(path: Path) -> None:
    """Refuse by its first bytes and its size what no parser need look at."""
    if not path.is_file():
        path.open("rb").close()  # says why
        raise ModelFileError(path, "no regular file", NEEDED)
    with path.open("rb") as file:
        is_archive = file.read(4) == b"PK\x03\x04"
    size = path.stat().st_size
    if path.suffix.lower() == ".onnx":
        needed = f"{NEEDED}; neural networks are not read"
        raise ModelFileError(path, "an ONNX file by its name", needed)
    if not is_archive:
        raise ModelFileError(path, f"{size} bytes that are no .npz archive" if size else "an empty file", NEEDED)
    if size > MAX_FILE_BYTES:
        raise ModelFileError(path, f"a file of {size} bytes", f"{NEEDED}, at most {MAX_FILE_BYTES} bytes")


def _starts(fields: NpzFields, name: str, total: int) -> npt.NDArray[np.int64]:
    starts = fields.integers(name, (-1,), 0, 2**31 - 1)
    if not 2 <= len(starts) <= MAX_TREES + 1 or starts[0] != 0 or starts[-1] != total or (np.diff(starts) < 1).any():
        raise ModelFileError(fields.path, f"'{name}' that don't divide {total} entries", "where each tree starts")
    return starts


def _check_tree(path: Path, number: int, nodes: npt.NDArray[np.int64], leaves: int) -> None:
    """Every test is within the patch, every child comes after its parent, every leaf exists: no walk ends astray."""
    is_leaf = nodes[:, 0] < 0
    child, place = nodes[:, 4], np.arange(len(nodes))
    sound = np.where(is_leaf, (child >= 0) & (child < leaves), (child > place) & (child + 1 < len(nodes)))
    within = (nodes[:, 1:3] >= 0).all(axis=1) & (nodes[:, 1:3] < PATCH * PATCH).all(axis=1) & (nodes[:, 0] < CHANNELS)
    bad = np.flatnonzero(~(sound & within))
    if len(bad):
        raise ModelFileError(
            path,
            f"tree {number} with an impossible node {nodes[bad[0]].tolist()}",
            "tests within a patch, valid children",
        )
