"""How well a fitted pose explains what was seen: distinguishes a followed hand from a lost one."""

from __future__ import annotations

from dataclasses import dataclass

COVERAGE_GAIN = 0.25
"""Merit of covering all hand pixels within reach."""

ELSEWHERE = 0.7
"""A finger whose joints are this far from where the hand detector saw them, `Sighting.measure`, is elsewhere. Measured
with onnxruntime and before second tries waited (today's counts: benchmarks/results/real_marks.md): with 0.6, 59 of 126
frames of an infrared recording are called lost, 2 of 8 marked ones wrongly; with 0.8, 48, and 3 of the 8 are called
`ok` with a fingertip in a wrong place. `uvr_cube_white` had 3 to 5 lost of 200 with any."""

HAND_ELSEWHERE = 0.75
"""A hand all of whose joints are that far from where it was seen is elsewhere where some misfit is left: a box passes
for a palm, a mirrored hand for the hand. Where the depth image settles it the detector is wrong: 3 of 12 frames of
`uvr_cube_white` that were called lost before look right in what shows of the hand; they are not marked."""

MISFIT, BROAD_MISFIT = 1.1e-4, 6e-5
"""More than this area, m², where drawn and seen disagree means that some finger is elsewhere: by the depth image alone,
and where the hand detector says so too."""

SHOWN = 1.2e-3
"""Of a hand that is followed this much shows, m²; one that is not there hides within, or behind, the other."""


@dataclass(frozen=True)
class Quality:
    """Agreement of a drawn hand with the hand pixels.

    Attributes:
        depth_residual: Median |drawn − seen| where both are, m; infinite where they never meet.
        inside: Share of drawn pixels, hidden ones apart, whose depth agrees with a hand pixel.
        explained: Share of hand pixels, forearm apart, whose depth agrees with a drawn pixel.
        silhouette_iou: Drawn and seen pixels (forearm and hidden apart): intersection over union.
        score: 0 to 1, to compare poses by: one minus the mean over that union of |drawn − seen| cut off at 20 mm, in
            units of the cut; a pixel that is only drawn or only seen counts as cut off.
        coverage: Share of all hand pixels within reach, forearm and all, whose depth agrees with a drawn pixel.
        misfit: Area, m², without its rim, of hand pixels before the wrist that no model explains, of skin in a depth
            shadow that none covers, and of drawn pixels before the wrist where something farther away, or free space,
            is seen.
        broad_misfit: The same without a wider rim: half of a finger's width is left of a finger that is elsewhere, and
            nothing of the fringe around a hand that is thinner, or is seen fatter, than its model.
        area: Of the drawn pixels whose depth agrees with a hand pixel, m², across the viewing rays.
        apart: Mean distance of the joints from where the hand detector saw them, 0 to 1 (`Sighting.measure`); None
            where it did not see the hand.
        worst_finger: The same of the finger that is farthest off.
        is_led: Whether the detector saw the hand only because it was told where to look (`Sighting.is_led`).
    """

    depth_residual: float
    inside: float
    explained: float
    silhouette_iou: float
    score: float
    coverage: float
    misfit: float
    broad_misfit: float
    area: float
    apart: float | None = None
    worst_finger: float | None = None
    is_led: bool = False

    @property
    def merit(self) -> float:
        """To compare different places of a hand by: one that leaves fingers to pass for a forearm covers less."""
        return self.score + COVERAGE_GAIN * self.coverage

    @property
    def agrees(self) -> bool:
        """Whether the hand is in its place; some fingers may not be."""
        return self.score >= 0.45 and self.inside >= 0.6 and self.explained >= 0.65 and self.depth_residual <= 0.010

    @property
    def is_gone(self) -> bool:
        """Whether the hand is not in its place, or nothing shows of it; pixels of another hand do not tell."""
        return not self.agrees or self.area < SHOWN

    @property
    def is_lost(self) -> bool:
        """Whether no one should believe this pose.

        A real hand of another shape leaves some misfit with every finger in its place; where the detector saw the hand
        by itself, it says whether one is not.
        """
        if self.worst_finger is None or self.is_led:
            return self.is_gone or self.misfit > MISFIT
        is_finger_elsewhere = self.broad_misfit > BROAD_MISFIT and self.worst_finger > ELSEWHERE
        is_hand_elsewhere = self.misfit > BROAD_MISFIT and (self.apart or 0.0) > HAND_ELSEWHERE
        return self.is_gone or is_finger_elsewhere or is_hand_elsewhere
