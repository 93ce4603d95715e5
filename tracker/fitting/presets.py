"""Sets of options that go together, under a name: what forms and `handloom track --preset` offer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tracker.errors import TrackingError


@dataclass(frozen=True)
class TrackPreset:
    """Values for some options; the others keep their defaults.

    Attributes:
        name: For commands.
        label: For people.
        help: One sentence: for what, and what it leaves out.
        one_hand_ms: Measured median time of a frame with one hand, ms.
        two_hands_and_object_ms: The same with two hands and an object.
        values: Option to value.
    """

    name: str
    label: str
    help: str
    one_hand_ms: float
    two_hands_and_object_ms: float
    values: dict[str, Any]


PRESETS: tuple[TrackPreset, ...] = (
    TrackPreset(
        "fast",
        "Fast",
        "For slow motion seen well: depth alone and few iterations; fingers may pass through things.",
        8.9,
        26.1,
        {"terms": "LO", "iterations": 5},
    ),
    TrackPreset(
        "balanced",
        "Balanced",
        "For most recordings: fingers stay out of each other, and fingertips help where the hand was nearly lost.",
        14.0,
        40.4,
        {"terms": "LO+SC", "iterations": 10},
    ),
    TrackPreset(
        "plausible",
        "Plausible",
        "For hands that hold an object: a simulation moves fingers that should touch it into contact.",
        14.8,
        46.1,
        {"terms": "LO+SCP", "iterations": 10},
    ),
    TrackPreset(
        "t16",
        "T16, as written",
        "To compare with the paper: its algorithm on full meshes, without our terms, second tries and searches.",
        138.0,
        292.0,
        {"method": "t16", "terms": "LO+SCP", "iterations": 10, "calibrate": False},
    ),
)
"""From the quickest to the most thorough. Times: benchmarks/presets.py, in docs/tracking.md."""

USUAL_PRESET = "balanced"
"""What forms begin with."""


def find_preset(name: str) -> TrackPreset:
    """The preset of a name.

    Raises:
        TrackingError: There is none; the message names those there are.
    """
    for preset in PRESETS:
        if preset.name == name:
            return preset
    raise TrackingError(f"There is no preset {name!r}; there are {', '.join(preset.name for preset in PRESETS)}.")
