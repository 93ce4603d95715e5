"""A PNG with a palette is read by others as what it was made from."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from server.sequences.palette_png import encode_palette_png


@pytest.mark.parametrize("shape", [(1, 1), (3, 7), (64, 48)])
def test_another_reader_finds_each_colour_where_it_was_and_index_zero_transparent(rng, shape) -> None:
    palette = rng.integers(0, 256, (256, 3)).astype(np.uint8)
    indices = rng.integers(0, 256, shape).astype(np.uint8)
    indices.flat[0] = 0
    image = cv2.imdecode(np.frombuffer(encode_palette_png(indices, palette), np.uint8), cv2.IMREAD_UNCHANGED)
    assert image.shape == (*shape, 4)
    assert np.array_equal(image[..., 3], np.where(indices == 0, 0, 255))
    seen = indices > 0
    assert np.array_equal(image[..., 2::-1][seen], palette[indices][seen])
