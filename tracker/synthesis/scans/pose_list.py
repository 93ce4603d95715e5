"""51 poses of a hand, as R17's protocol has them: joint exploration, the grasps of Feix et al. 2016, and a few mixed.

Angles are anatomical, degrees: flexion of the fingers from the straight finger, spread towards the thumb's side of the
hand from the line wrist to middle knuckle, the thumb's two first bones from where they are at rest.
"""

from __future__ import annotations

from dataclasses import dataclass

from tracker.model.joints import FINGERS

Finger = tuple[float, float, float]

TOGETHER = (1.0, 0.0, 1.0, 3.0)
"""How far index, middle, ring and little finger are spread, degrees, positive towards the thumb."""
CLOSED = (3.0, 0.0, -3.0, -6.0)
"""Of bent fingers side by side, which come together towards the thumb's base."""

NATURAL = (5.0, -1.0, -5.0, -10.0)
SPREAD = (15.0, -3.0, -18.0, -32.0)
"""At ease, and as far as fingers go."""


@dataclass(frozen=True)
class HeldObject:
    """What a grasp holds: kind is "ball" or "rod"; radius is at most this, m."""

    kind: str
    radius: float


@dataclass(frozen=True)
class HandPose:
    """One pose.

    Attributes:
        name: What `handloom synthesize-scans --poses` takes.
        thumb: Flexion, abduction and twist of the metacarpal, flexion of the proximal and distal phalanx.
        index, middle, ring, little: Flexion of the three phalanges.
        spread: Of index, middle, ring and little finger.
        arch: Flexion of the little finger's metacarpal; the ring finger's goes with it by half.
        touches: Pairs of bones whose skin touches.
        held: What is in the hand.
    """

    name: str
    thumb: tuple[float, float, float, float, float]
    index: Finger
    middle: Finger
    ring: Finger
    little: Finger
    spread: tuple[float, float, float, float] = NATURAL
    arch: float = 2.0
    touches: tuple[tuple[str, str], ...] = ()
    held: HeldObject | None = None


def _bent(name: str, finger: str) -> HandPose:
    straight: Finger = (2.0, 6.0, 4.0)
    bent: Finger = (70.0, 85.0, 45.0)
    index, middle, ring, little = (bent if other == finger else straight for other in FINGERS[1:])
    return HandPose(name, (0, 0, 0, 5, 5), index, middle, ring, little, NATURAL)


def _touch(*fingers: str) -> tuple[tuple[str, str], ...]:
    return tuple(("thumb_distal", f"{finger}_distal") for finger in fingers)


CURLED: Finger = (80.0, 98.0, 55.0)
TIGHT: Finger = (85.0, 104.0, 62.0)
"""Fingers of a fist, degrees."""

EXPLORATION = (
    HandPose("flat_together", (-12, -12, 0, -5, 0), (2, 4, 3), (2, 4, 3), (2, 4, 3), (2, 5, 3), TOGETHER, 0.0),
    HandPose("flat_spread", (-15, -5, 0, -5, -8), (-8, 3, 2), (-8, 3, 2), (-8, 3, 2), (-8, 4, 2), SPREAD, -2.0),
    HandPose("relaxed", (4, 4, 0, 12, 14), (18, 28, 14), (24, 32, 16), (28, 34, 18), (30, 32, 16), NATURAL, 4.0),
    HandPose("thumb_across", (30, -4, 8, 40, 45), (4, 8, 4), (4, 8, 4), (4, 8, 4), (4, 8, 4), TOGETHER, 4.0),
    HandPose("thumb_out", (-20, 14, 0, -8, -10), (4, 8, 4), (4, 8, 4), (4, 8, 4), (4, 8, 4), NATURAL, 0.0),
    _bent("index_bent", "index"),
    _bent("middle_bent", "middle"),
    _bent("ring_bent", "ring"),
    _bent("little_bent", "little"),
    HandPose("half_curl", (10, 6, 4, 18, 20), (42, 52, 26), (46, 55, 28), (50, 56, 28), (52, 54, 26), NATURAL, 6.0),
    HandPose("table_top", (5, 5, 0, 8, 5), (78, 8, 4), (80, 8, 4), (80, 8, 4), (80, 10, 4), CLOSED, 8.0),
    HandPose("hook", (-4, -4, 0, 0, 5), (6, 92, 50), (6, 95, 52), (6, 95, 52), (8, 90, 50), CLOSED, 2.0),
    HandPose("straight_fist", (4, -8, 0, 8, 10), (78, 95, 4), (82, 98, 4), (82, 98, 4), (82, 95, 4), CLOSED, 8.0),
    HandPose(
        "fist", (16, 22, 12, 34, 38), TIGHT, TIGHT, TIGHT, TIGHT, CLOSED, 12.0, (("thumb_distal", "middle_middle"),)
    ),
)

GRASPS = (
    HandPose("large_diameter", (4, 18, 8, 12, 14), (32, 38, 22), (34, 40, 24), (36, 40, 24), (40, 40, 22), NATURAL, 6.0,
             held=HeldObject("rod", 0.045)),
    HandPose("small_diameter", (22, 14, 8, 28, 28), (62, 82, 42), (66, 88, 45), (70, 88, 46), (74, 84, 44), CLOSED,
             10.0, held=HeldObject("rod", 0.016)),
    HandPose("medium_wrap", (14, 18, 8, 22, 24), (46, 58, 32), (48, 62, 34), (52, 62, 34), (56, 60, 32), CLOSED, 8.0,
             held=HeldObject("rod", 0.028)),
    HandPose("adducted_thumb", (-6, -8, 0, 2, 4), (66, 88, 46), (70, 92, 48), (74, 92, 48), (78, 88, 46), CLOSED,
             10.0, held=HeldObject("rod", 0.014)),
    HandPose("light_tool", (18, 18, 12, 32, 36), (74, 96, 52), (78, 98, 54), (82, 98, 54), (84, 96, 52), CLOSED, 12.0,
             (("thumb_distal", "index_middle"),), HeldObject("rod", 0.009)),
    HandPose("prismatic_4_finger", (16, 24, 12, 22, 14), (52, 36, 20), (56, 34, 20), (58, 32, 20), (60, 28, 18),
             CLOSED, 8.0, held=HeldObject("rod", 0.008)),
    HandPose("prismatic_3_finger", (16, 24, 12, 22, 14), (52, 38, 20), (56, 36, 20), (60, 34, 20), (62, 70, 35),
             CLOSED, 8.0, held=HeldObject("rod", 0.008)),
    HandPose("prismatic_2_finger", (16, 22, 10, 20, 14), (50, 40, 22), (54, 40, 22), (66, 76, 38), (70, 76, 38),
             CLOSED, 8.0, held=HeldObject("rod", 0.008)),
    HandPose("palmar_pinch", (14, 20, 8, 18, 10), (52, 36, 14), (28, 30, 14), (26, 30, 14), (26, 28, 14), NATURAL, 4.0,
             _touch("index")),
    HandPose("power_disk", (0, 14, 6, 12, 20), (18, 42, 34), (20, 44, 36), (20, 44, 36), (20, 42, 34), SPREAD, 2.0,
             held=HeldObject("ball", 0.045)),
    HandPose("power_sphere", (2, 20, 8, 14, 18), (30, 42, 28), (32, 42, 28), (34, 42, 28), (36, 42, 26), SPREAD, 4.0,
             held=HeldObject("ball", 0.04)),
    HandPose("precision_disk", (2, 18, 8, 16, 18), (38, 34, 26), (40, 34, 26), (42, 34, 26), (44, 34, 26), SPREAD, 4.0,
             held=HeldObject("ball", 0.035)),
    HandPose("precision_sphere", (8, 22, 10, 18, 16), (44, 36, 24), (46, 38, 24), (48, 38, 24), (50, 38, 24), SPREAD,
             6.0, held=HeldObject("ball", 0.026)),
    HandPose("tripod", (14, 22, 10, 22, 18), (52, 44, 22), (56, 44, 22), (52, 62, 34), (54, 64, 34), NATURAL, 6.0,
             held=HeldObject("ball", 0.012)),
    HandPose("fixed_hook", (-4, 2, 0, 6, 8), (38, 92, 48), (40, 96, 50), (42, 96, 50), (46, 92, 48), CLOSED, 6.0,
             held=HeldObject("rod", 0.012)),
    HandPose("lateral", (8, -4, 0, 16, 22), (56, 82, 42), (66, 88, 46), (70, 88, 46), (72, 86, 44), CLOSED, 8.0,
             (("thumb_distal", "index_middle"),)),
    HandPose("index_finger_extension", (20, 12, 6, 24, 24), (16, 14, 8), (66, 84, 44), (70, 86, 44), (74, 84, 42),
             NATURAL, 9.0, held=HeldObject("rod", 0.012)),
    HandPose("extension_type", (12, 14, 8, 10, 4), (50, 14, 6), (54, 12, 6), (54, 12, 6), (54, 12, 6), TOGETHER, 4.0),
    HandPose("distal_type", (4, 8, 4, 26, 32), (30, 62, 40), (34, 66, 42), (48, 76, 40), (56, 76, 40), NATURAL, 4.0),
    HandPose("writing_tripod", (14, 16, 8, 26, 28), (48, 52, 18), (60, 60, 26), (70, 74, 36), (74, 76, 36), CLOSED,
             8.0, (("thumb_distal", "index_distal"),), HeldObject("rod", 0.004)),
    HandPose("tripod_variation", (16, 14, 8, 26, 28), (44, 50, 20), (48, 54, 22), (66, 80, 40), (70, 80, 38), CLOSED,
             8.0, held=HeldObject("rod", 0.005)),
    HandPose("parallel_extension", (14, 16, 8, 12, 2), (44, 8, 4), (46, 8, 4), (46, 8, 4), (46, 8, 4), TOGETHER, 4.0),
    HandPose("adduction_grip", (0, -2, 0, 6, 6), (12, 16, 8), (10, 14, 8), (24, 34, 18), (28, 36, 18),
             (-3.0, 4.0, -6.0, -10.0), 2.0),
    HandPose("tip_pinch", (14, 18, 8, 32, 46), (52, 58, 42), (36, 40, 22), (36, 40, 22), (36, 38, 20), NATURAL, 4.0,
             _touch("index")),
    HandPose("lateral_tripod", (18, 2, 4, 24, 26), (52, 72, 34), (62, 76, 36), (72, 84, 42), (74, 84, 42), CLOSED,
             8.0, (("thumb_distal", "index_middle"),)),
    HandPose("sphere_4_finger", (8, 22, 10, 18, 16), (42, 40, 26), (44, 42, 26), (46, 42, 26), (60, 66, 34), SPREAD,
             5.0, held=HeldObject("ball", 0.026)),
    HandPose("quadpod", (14, 24, 12, 20, 16), (52, 42, 22), (56, 42, 22), (58, 40, 22), (60, 62, 32), NATURAL, 7.0,
             held=HeldObject("ball", 0.014)),
    HandPose("sphere_3_finger", (8, 22, 10, 18, 18), (40, 44, 26), (42, 46, 26), (64, 78, 40), (68, 78, 40), NATURAL,
             6.0, held=HeldObject("ball", 0.024)),
    HandPose("stick", (12, 0, 2, 20, 20), (60, 78, 40), (70, 88, 46), (74, 90, 46), (76, 88, 46), CLOSED, 9.0,
             (("thumb_distal", "index_middle"),), HeldObject("rod", 0.007)),
    HandPose("palmar", (6, -6, 0, 12, 10), (26, 20, 8), (26, 20, 8), (26, 20, 8), (26, 20, 8), TOGETHER, 4.0),
    HandPose("ring", (12, 16, 8, 24, 28), (48, 62, 34), (34, 40, 22), (32, 38, 20), (30, 36, 18), NATURAL, 4.0,
             _touch("index"), HeldObject("rod", 0.016)),
)  # fmt: skip

MIXED = (
    HandPose("point", (18, 20, 12, 36, 40), (2, 5, 3), CURLED, CURLED, CURLED, CLOSED, 10.0,
             (("thumb_distal", "middle_middle"),)),
    HandPose("thumb_up", (-22, -10, 0, -12, -18), TIGHT, TIGHT, TIGHT, TIGHT, CLOSED, 12.0),
    HandPose("victory", (24, 20, 12, 42, 40), (0, 4, 2), (0, 4, 2), CURLED, CURLED, (14.0, -10.0, -2.0, 2.0), 10.0,
             (("thumb_distal", "ring_middle"),)),
    HandPose("fist_thumb_inside", (32, 2, 10, 40, 40), (70, 84, 40), (72, 86, 40), (74, 88, 44), (78, 90, 46), CLOSED,
             10.0),
    HandPose("thumb_to_little", (28, 22, 14, 34, 26), (30, 34, 18), (36, 38, 20), (42, 44, 22), (58, 50, 26), NATURAL,
             13.0, _touch("little")),
    HandPose("horns", (20, 20, 12, 38, 40), (0, 4, 2), CURLED, CURLED, (0, 4, 2), NATURAL, 6.0,
             (("thumb_distal", "middle_middle"),)),
)  # fmt: skip

POSES = (*EXPLORATION, *GRASPS, *MIXED)
POSE_NAMES = tuple(pose.name for pose in POSES)

FISTS = (
    "fist",
    "straight_fist",
    "hook",
    "small_diameter",
    "adducted_thumb",
    "light_tool",
    "fixed_hook",
    "lateral",
    "thumb_up",
    "fist_thumb_inside",
)
"""Poses whose fingertips hide in the palm: a fifth of all."""
