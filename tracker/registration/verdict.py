"""What a registration is worth, judged without truth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Verdict:
    """A judgement.

    Attributes:
        name: "good", "doubtful" or "bad".
        score: Lower is better.
        reasons: Why it is not good; what else is worth knowing.
    """

    name: str
    score: float
    reasons: tuple[str, ...]
