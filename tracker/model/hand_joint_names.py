"""Which joint of a hand a name in somebody's file means: WebXR, VRM, Mixamo, Unreal, MakeHuman and the like."""

from __future__ import annotations

import re

from tracker.model.joints import FINGERS

FINGER_WORDS = {
    "thumb": "thumb",
    "index": "index",
    "ring": "ring",
    "little": "little",
    "pinky": "little",
    "small": "little",
}
SEGMENT_WORDS = {
    "metacarpal": "metacarpal",
    "carpal": "metacarpal",
    "meta": "metacarpal",
    "proximal": "proximal",
    "intermediate": "middle",
    "distal": "distal",
    "tip": "tip",
    "end": "tip",
}
SIDE_WORDS = {"right": "right", "r": "right", "left": "left", "l": "left"}
FINGER_NUMBERS = ("metacarpal", "proximal", "middle", "distal", "tip")
THUMB_NUMBERS = (None, "metacarpal", "proximal", "distal", "tip")


def split_words(name: str) -> list[str]:
    """Words and numbers in a name: "RightHandIndex1" and "index-finger-phalanx-distal" alike."""
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])|\d+", name[:200])]


def find_side(names: list[str]) -> str | None:
    """ "right" or "left" when the names say so and do not contradict each other."""
    sides = {SIDE_WORDS[word] for name in names for word in split_words(name) if word in SIDE_WORDS}
    return sides.pop() if len(sides) == 1 else None


def map_joint_names(names: list[str]) -> dict[tuple[str, str], int]:
    """Place of each joint of a hand in the list, by (finger, segment), with the segments of `hand_parts` and "tip".

    The wrist is ("wrist", ""). A name that means no joint of a hand is left out; the first of two equal ones counts.
    """
    found: dict[tuple[str, str], int] = {}
    for place, name in enumerate(names):
        joint = _read_name(name)
        if joint is not None:
            found.setdefault(joint, place)
    if ("wrist", "") not in found:
        hands = [
            place
            for place, name in enumerate(names)
            if "hand" in split_words(name) and _finger(split_words(name)) is None
        ]
        if hands:
            found["wrist", ""] = hands[0]
    # VRM 0 and Unity call the thumb's three bones proximal, intermediate, distal
    if ("thumb", "middle") in found:
        if ("thumb", "metacarpal") not in found and ("thumb", "proximal") in found:
            found["thumb", "metacarpal"] = found["thumb", "proximal"]
            found["thumb", "proximal"] = found["thumb", "middle"]
        del found["thumb", "middle"]
    return found


def _read_name(name: str) -> tuple[str, str] | None:
    words = split_words(name)
    finger = _finger(words)
    if finger is None:
        return ("wrist", "") if "wrist" in words else None
    segments = _segments(words, finger)
    if segments:
        return finger, segments[-1] if "tip" in segments else segments[0]
    segment = _numbered_segment(words, THUMB_NUMBERS if finger == "thumb" else FINGER_NUMBERS)
    return None if segment is None else (finger, segment)


def _segments(words: list[str], finger: str) -> list[str]:
    """Segments that a name's words mean; the first "middle" of a middle finger's name may be the finger."""
    rest = [word for word in words if word in SEGMENT_WORDS or word == "middle"]
    if finger == "middle":
        rest = rest[1:] if rest and rest[0] == "middle" else [word for word in rest if word != "middle"]
    return [SEGMENT_WORDS.get(word, "middle") for word in rest]


def _numbered_segment(words: list[str], numbers: tuple[str | None, ...]) -> str | None:
    """The segment that the name's last number of a segment means."""
    digits = [int(word) for word in words if word.isdigit() and int(word) < len(numbers)]
    return numbers[digits[-1]] if digits else None


def _finger(words: list[str]) -> str | None:
    for word in words:
        if word in FINGER_WORDS:
            return FINGER_WORDS[word]
    return "middle" if "middle" in words or "mid" in words else None


def missing_joints(found: dict[tuple[str, str], int]) -> list[str]:
    """Joints without which a hand is none; metacarpals of the four fingers and tips may be missing."""
    needed = [("wrist", "")]
    for finger in FINGERS:
        segments = ("metacarpal", "proximal", "distal") if finger == "thumb" else ("proximal", "middle", "distal")
        needed += [(finger, segment) for segment in segments]
    return [" ".join(joint).strip() for joint in needed if joint not in found]
