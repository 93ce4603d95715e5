"""Where annotations belong, and which of these places somebody must not read."""

from __future__ import annotations

import uuid
from dataclasses import dataclass


@dataclass(frozen=True)
class Place:
    """Where an annotation belongs: one hand in one image, in a blind replica or (empty) for everybody."""

    sequence_id: uuid.UUID
    camera: str
    frame: int
    hand: str
    replica: str = ""

    def __str__(self) -> str:
        return f"the {self.hand} hand in frame {self.frame} of {self.camera}"


@dataclass(frozen=True)
class HiddenPlaces:
    """Places that somebody must not read: every one of these hands in every one of these cameras and frames."""

    frames: frozenset[int]
    cameras: frozenset[str]
    hands: frozenset[str]

    def __contains__(self, place: Place) -> bool:
        return place.frame in self.frames and place.camera in self.cameras and place.hand in self.hands
