"""Colour says skin as the published mixtures do, computed pixel by pixel without a table."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import norm

from tracker.observation.skin import _OTHER, _SKIN, LEAST, LEVELS, MOST, compute_skin_log_ratio


def log_ratio(color: np.ndarray) -> float:
    """[T16] §3.2.1 by the book."""
    skin, other = (
        sum(row[6] * norm.pdf(color, row[:3], np.sqrt(row[3:6])).prod() for row in mixture)
        for mixture in (_SKIN, _OTHER)
    )
    return float(np.clip(np.log(max(skin, 1e-300) / max(other, 1e-300)), LEAST, MOST))


def test_both_mixtures_are_whole() -> None:
    assert len(_SKIN) == len(_OTHER) == 16
    assert np.allclose([_SKIN[:, 6].sum(), _OTHER[:, 6].sum()], 1.0, atol=2e-3)


def test_the_table_is_the_mixtures_at_the_middle_of_each_of_its_cells(rng) -> None:
    cell = 256 // LEVELS
    corners = rng.integers(0, LEVELS, (60, 3)) * cell
    exact = [log_ratio(corner + 0.5 * (cell - 1)) for corner in corners]
    for offset in (0, cell - 1):
        found = compute_skin_log_ratio((corners + offset).astype(np.uint8)[None])[0]
        assert np.allclose(found, exact, atol=1e-4), "every colour of a cell counts as its middle"


@pytest.mark.parametrize(
    ("color", "is_skin"),
    [((200, 140, 115), True), ((224, 172, 140), True), ((141, 85, 60), True), ((40, 90, 120), False),
     ((255, 255, 255), False), ((0, 0, 0), False), ((60, 160, 60), False)],
)  # fmt: skip
def test_hands_of_several_people_are_likelier_skin_than_tables_walls_and_leaves(color, is_skin) -> None:
    assert (compute_skin_log_ratio(np.full((1, 1, 3), color, np.uint8))[0, 0] > 0.0) is np.bool_(is_skin)
