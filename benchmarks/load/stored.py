"""What the studio holds of the gestures made at browsers, against what was on their screens."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import httpx

from benchmarks.load.browser_annotators import Gesture

SAME_PX = 0.02
"""Two gestures are told apart by where they were; labels are stored to a hundredth of a pixel."""

REACH_PX = 1.5
"""A click this near to an earlier one may have met its joint and chosen it, px of the picture."""


@dataclass(frozen=True)
class Judgement:
    """Of all gestures at browsers.

    Attributes:
        taken: Gestures that a page took.
        refused: Those it did not take, because its picture was another one or none.
        stored: Positions that the studio holds, in any revision.
        lost: Taken and not stored.
        elsewhere: Stored on another frame than the one that was on the screen.
    """

    taken: int
    refused: int
    stored: int
    lost: list[str]
    elsewhere: list[str]


def judge(url: str, base: str, frames: Iterable[int], gestures: Sequence[Gesture]) -> Judgement:
    """Compare the gestures with the whole history of the frames that they may be on."""
    found: dict[Gesture, set[int]] = {gesture: set() for gesture in gestures}
    stored = 0
    with httpx.Client(base_url=f"{url}/api/v1", timeout=60) as client:
        for frame in frames:
            answer = client.get(f"{base}/{frame}/right/history")
            if answer.status_code == 404:
                continue
            answer.raise_for_status()
            places = {(x, y) for item in answer.json()["items"] for x, y, v in item["points"] or () if v == 2}
            stored += len(places)
            for gesture in gestures:
                if any(_is_at(gesture, x, y) for x, y in places):
                    found[gesture].add(frame)
    # A page at idle priority may say later than is looked that it took a click: what is stored was taken.
    last = {(one.frame, one.joint): one for one in gestures if one.is_taken or found[one]}
    lost = [
        f"{gesture} is stored nowhere; its frame: {_neighbours(gesture, gestures)}"
        for at, gesture in enumerate(gestures)
        if gesture.is_taken
        and not found[gesture]
        and last[gesture.frame, gesture.joint] is gesture
        and not _meets_another(gesture, gestures[:at])
    ]
    elsewhere = [
        f"{gesture} is stored on {sorted(on)}"
        for gesture, on in found.items()
        if on and (gesture.frame not in on or on - _frames_at_the_place_of(gesture, gestures))
    ]
    taken = sum(gesture.is_taken for gesture in gestures)
    return Judgement(taken, len(gestures) - taken, stored, lost, elsewhere)


def _frames_at_the_place_of(gesture: Gesture, gestures: Sequence[Gesture]) -> set[int | None]:
    """Frames on which somebody clicked there: of some hundred clicks two may be at one place by chance."""
    return {one.frame for one in gestures if _is_at(one, gesture.x, gesture.y)}


def _is_at(gesture: Gesture, x: float, y: float) -> bool:
    return abs(gesture.x - x) < SAME_PX and abs(gesture.y - y) < SAME_PX


def _neighbours(gesture: Gesture, gestures: Sequence[Gesture]) -> list[Gesture]:
    return [one for one in gestures if one.frame == gesture.frame and one is not gesture]


def _meets_another(gesture: Gesture, earlier: Sequence[Gesture]) -> bool:
    return any(
        one.frame == gesture.frame and (one.x - gesture.x) ** 2 + (one.y - gesture.y) ** 2 < REACH_PX**2
        for one in earlier
    )
