"""The bar on physics: with P what is held stays where it is."""

from __future__ import annotations

from functools import partial
from itertools import product

from benchmarks.studies.bar import Bar, Verdict
from benchmarks.studies.held import Held
from benchmarks.studies.paper import DISPLACEMENT_MM
from benchmarks.studies.study import Extent
from benchmarks.studies.trial import NotMeasured, Results

SHARE = 0.5
WITHOUT, WITH = "LO+SC", "LO+SCP"
NAMES = ("15", "20")
NOTE = (
    "SD-obman: 35 steps of 1/240 s. Not comparable with T16's "
    f"{DISPLACEMENT_MM[WITHOUT]} and {DISPLACEMENT_MM[WITH]} mm, of another Bullet with steps of 0.1 s and a table."
)


def list_held_bars(extent: Extent) -> list[Bar]:
    """One for each sequence, with the rendered hand and with our own."""
    bars = []
    for name, own in product(NAMES, (False, True)):
        pair = Held(name, WITHOUT, extent.frames, own), Held(name, WITH, extent.frames, own)
        bars.append(
            Bar(
                "displacement after simulation, frames where the truth's own is at most 3 mm",
                f"{name}, {'our own hand' if own else 'same model'}: {WITH} at most half of {WITHOUT}",
                pair,
                partial(_judge, *pair),
            )
        )
    return bars


def _judge(without: Held, with_it: Held, results: Results) -> Verdict:
    before, after = results[without], results[with_it]
    if not before["held"]:
        raise NotMeasured(f"{without.sequence}: the truth holds the object in none of {before['frames']} frames.")
    words = (
        f"{before['mean_mm']:.2f} to {after['mean_mm']:.2f} mm (median {before['median_mm']:.2f} to "
        f"{after['median_mm']:.2f}; truth {before['true_mean_mm']:.2f}), {before['held']} of {before['frames']} frames"
    )
    share = after["mean_mm"] / before["mean_mm"]
    return Verdict(words, share <= SHARE, share / SHARE, NOTE)
