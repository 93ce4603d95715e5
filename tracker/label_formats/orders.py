"""In which order others list the joints of a hand, and what they call them."""

from __future__ import annotations

import re
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.errors import AnnotationError
from tracker.model.joints import FINGERS, HAND_JOINTS

Array = npt.NDArray[np.float64]

_PARTS = {"thumb": ("cmc", "mcp", "ip", "tip")} | dict.fromkeys(FINGERS[1:], ("mcp", "pip", "dip", "tip"))


def _list_finger(finger: str) -> tuple[str, ...]:
    return tuple(f"{finger}_{part}" for part in _PARTS[finger])


WRIST_FIRST: tuple[str, ...] = ("wrist", *(joint for finger in FINGERS for joint in _list_finger(finger)))

JOINT_ORDERS: dict[str, tuple[str, ...]] = {
    "handloom": HAND_JOINTS,
    "openpose": WRIST_FIRST,
    "mediapipe": WRIST_FIRST,
    "coco_wholebody": WRIST_FIRST,
    "freihand": WRIST_FIRST,
    "mano": (
        "wrist",
        *(joint for finger in ("index", "middle", "little", "ring", "thumb") for joint in _list_finger(finger)[:3]),
        *(f"{finger}_tip" for finger in FINGERS),
    ),
    "interhand": (*(joint for finger in FINGERS for joint in reversed(_list_finger(finger))), "wrist"),
}
"""Joints of one hand, each by our name. MANO: its 16 joints, then the tips from thumb to little finger as its users
append them. InterHand2.6M: tip to base, the wrist last; the right hand stands before the left one."""

_WORDS = {"forefinger": "index", "pinky": "little", "pinkie": "little", "small": "little"}


def to_order(values: Array, order: str) -> Array:
    """(21, n) values of our joints in the order of others."""
    assert values.shape[0] == len(HAND_JOINTS), values.shape
    return values[[HAND_JOINTS.index(name) for name in JOINT_ORDERS[order]]]


def from_order(values: Array, order: str) -> Array:
    """(21, n) values of others' joints in our order."""
    assert values.shape[0] == len(HAND_JOINTS), values.shape
    return values[[JOINT_ORDERS[order].index(name) for name in HAND_JOINTS]]


def find_joint(name: str) -> int | None:
    """Which of our joints a name means: `index_mcp`, `INDEX_FINGER_MCP`, `pinky_tip`, `forefinger1`, `wrist`.

    Numbers count from the base of a finger, 1 to 4. A name that means none of them is None.
    """
    found: list[str] = re.findall(r"[a-z]+|\d+", name[:100].lower())
    words: list[str] = [_WORDS.get(word) or word for word in found]
    words = [word for word in words if word not in ("finger", "hand", "l", "r", "left", "right", "joint")]
    if words == ["wrist"]:
        return 0
    if len(words) != 2 or words[0] not in FINGERS:
        return None
    finger, part = words
    if part in ("1", "2", "3", "4"):
        part = _PARTS[finger][int(part) - 1]
    if finger == "thumb":
        part = {"tm": "cmc", "dip": "ip", "pip": "ip"}.get(part, part)
    full = f"{finger}_{part}"
    return HAND_JOINTS.index(full) if full in HAND_JOINTS else None


def read_names(names: Sequence[str], what: str) -> list[int]:
    """Place in our order of each of 21 names; raises when they are not the 21 joints of a hand, each once."""
    found = [find_joint(name) for name in names]
    strange = [name for name, joint in zip(names, found, strict=True) if joint is None]
    missing = [joint for number, joint in enumerate(HAND_JOINTS) if number not in found]
    if strange or missing or len(names) != len(HAND_JOINTS):
        raise AnnotationError(
            f"{what}: needed the 21 joints of a hand, each once; unknown {strange[:5] or 'none'}, "
            f"missing {missing[:5] or 'none'}, {len(names)} in all. Name them like {', '.join(HAND_JOINTS[:3])} ..."
        )
    return [joint for joint in found if joint is not None]
