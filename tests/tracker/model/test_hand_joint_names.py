"""Names that people give to the joints of a hand."""

from __future__ import annotations

import pytest

from tracker.model.hand_joint_names import find_side, map_joint_names, missing_joints, split_words
from tracker.model.joints import FINGERS


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("RightHandIndex1", ["right", "hand", "index", "1"]),
        ("index-finger-phalanx-distal", ["index", "finger", "phalanx", "distal"]),
        ("J_Bip_R_Little2", ["j", "bip", "r", "little", "2"]),
        ("mixamorig:LeftHandPinky4", ["mixamorig", "left", "hand", "pinky", "4"]),
    ],
)
def test_a_name_is_split_into_words_and_numbers(name: str, words: list[str]) -> None:
    assert split_words(name) == words


def mixamo(side: str) -> list[str]:
    fingers = ("Thumb", "Index", "Middle", "Ring", "Pinky")
    return [f"mixamorig:{side}Hand", *(f"mixamorig:{side}Hand{finger}{k}" for finger in fingers for k in (1, 2, 3, 4))]


def vrm(side: str) -> list[str]:
    fingers = ("Index", "Middle", "Ring", "Little")
    names = [f"{side}Hand", *(f"{side}Thumb{part}" for part in ("Metacarpal", "Proximal", "Distal"))]
    return names + [f"{side}{finger}{part}" for finger in fingers for part in ("Proximal", "Intermediate", "Distal")]


def unity(side: str) -> list[str]:
    parts = ("Proximal", "Intermediate", "Distal")
    fingers = ("Thumb", "Index", "Middle", "Ring", "Little")
    return [f"{side}Hand", *(f"{side} {finger} {part}" for finger in fingers for part in parts)]


def unreal(side: str) -> list[str]:
    end = side[0].lower()
    fingers = ("thumb", "index", "middle", "ring", "pinky")
    return [f"hand_{end}", *(f"{finger}_{k:02d}_{end}" for finger in fingers for k in (1, 2, 3))]


@pytest.mark.parametrize("style", [mixamo, vrm, unity, unreal])
@pytest.mark.parametrize("side", ["Right", "Left"])
def test_common_rigs_are_understood(style, side: str) -> None:
    names = style(side)
    found = map_joint_names(names)
    assert missing_joints(found) == []
    assert find_side(names) == side.lower()
    assert found["wrist", ""] == 0
    places = [found["thumb", segment] for segment in ("metacarpal", "proximal", "distal")]
    assert places == sorted(places)
    for finger in FINGERS[1:]:
        places = [found[finger, segment] for segment in ("proximal", "middle", "distal")]
        assert places == sorted(places) and len(set(places)) == 3


def test_the_middle_finger_is_not_taken_for_a_middle_bone() -> None:
    found = map_joint_names(["middle-finger-phalanx-proximal", "middle-finger-phalanx-intermediate", "index_middle"])
    assert found == {("middle", "proximal"): 0, ("middle", "middle"): 1, ("index", "middle"): 2}


def test_two_sides_in_one_file_tell_no_side() -> None:
    assert find_side(["RightHand", "LeftHand"]) is None


def test_what_is_missing_is_named() -> None:
    assert missing_joints(map_joint_names(["hips", "spine"]))[:2] == ["wrist", "thumb metacarpal"]
