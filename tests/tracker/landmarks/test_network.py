"""The networks of the repository say what their originals say."""

from __future__ import annotations

import hashlib
from pathlib import Path

import numpy as np
import pytest

from tracker.landmarks.network import DATA, load_network

ORIGINALS = Path(__file__).with_name("originals.npz")
"""Written by `scripts/build_hand_networks.py --references`, which ran the originals."""

HASHES = {
    "palms": "b220c5622073db78af0451ddc8e446368e19dc345bc4688e43bdcba0461acc99",
    "landmarks": "a5da1d23475847bb518ae1242e9ff2529f39feb2a66d1f0289bd6b318ae601bb",
}


@pytest.mark.parametrize("name", HASHES)
def test_a_network_is_the_one_that_the_script_made(name: str) -> None:
    assert hashlib.sha256((DATA / f"{name}.onnx").read_bytes()).hexdigest() == HASHES[name]


@pytest.mark.parametrize(
    ("name", "outputs"),
    [("palms", ("boxes", "scores")), ("landmarks", ("points", "presence", "side", "points_3d"))],
)
def test_a_network_says_what_its_original_says(name: str, outputs: tuple[str, ...]) -> None:
    with np.load(ORIGINALS) as originals:
        image = np.repeat(np.repeat(originals[f"{name}/image"], 16, axis=2), 16, axis=3)
        told = load_network(name, outputs)(image)
        for output in outputs:
            assert told[output].shape == originals[f"{name}/{output}"].shape
            np.testing.assert_allclose(told[output], originals[f"{name}/{output}"], atol=2e-3)  # boxes, points: px
