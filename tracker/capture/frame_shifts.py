"""How far cameras are shifted, as people write it."""

from __future__ import annotations

from tracker.errors import ImportRefusedError

NO_SHIFT = "none"
"""Said where a proposal is declined."""

MOST = 100_000
"""Frames that a camera may be shifted by: an hour at 30 frames a second is 108,000."""


def parse_shifts(text: str) -> dict[str, int]:
    """Frames by camera of words such as `cam1=+3, cam2=-2`; of `none`, nothing."""
    shifts: dict[str, int] = {}
    if text.strip() == NO_SHIFT:
        return shifts
    for word in filter(None, (word.strip() for word in text.replace(",", " ").split())):
        name, equals, frames = word.partition("=")
        try:
            number = int(frames)
        except ValueError:
            equals, number = "", 0
        if not name or not equals or name in shifts or abs(number) > MOST:
            raise ImportRefusedError(
                f"The shift {word!r} cannot be read; needed CAMERA=FRAMES for each camera once, such as cam1=+3, of at "
                f"most {MOST} frames."
            )
        shifts[name] = number
    return shifts
