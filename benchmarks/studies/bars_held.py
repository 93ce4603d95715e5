"""The bars on physics: what the motion says is held counts as held, and with P it stays where it is."""

from __future__ import annotations

from functools import partial
from itertools import product

from benchmarks.studies.bar import Bar, Verdict, at_most
from benchmarks.studies.held import Held
from benchmarks.studies.paper import DISPLACEMENT_MM
from benchmarks.studies.study import Extent
from benchmarks.studies.trial import NotMeasured, Results

SHARE = 0.5
STABLE_SHARE = 0.9
COST_PX = 0.05
WITHOUT, WITH = "LO+SC", "LO+SCP"
NAMES = ("15", "20")
GROUP = "held ball (15) and cube (20): frames in which the hand carries them"
NOTE = (
    "35 steps of 1/240 s, contacts of 5 mm radius; gravity of the cube along the side that it lies on at first. Not "
    f"comparable with T16's {DISPLACEMENT_MM[WITHOUT]} and {DISPLACEMENT_MM[WITH]} mm, of another Bullet with steps of "
    "0.1 s and a table."
)


def list_held_bars(extent: Extent) -> list[Bar]:
    """The truth; then with the rendered hand and with our own: how many stay, how far it moves, what it costs."""
    bars = []
    for name in NAMES:
        run = Held(name, WITHOUT, extent.frames)
        what = f"{name}, the truth: at least {STABLE_SHARE:.0%} stay"
        bars.append(Bar(GROUP, what, (run,), partial(_judge_stable, run, "truth")))
    for name, own in product(NAMES, (False, True)):
        pair = Held(name, WITHOUT, extent.frames, own), Held(name, WITH, extent.frames, own)
        who = f"{name}, {'our own hand' if own else 'same model'}"
        what = f"{who}, {WITH}: at least {STABLE_SHARE:.0%} stay"
        bars.append(Bar(GROUP, what, pair[1:], partial(_judge_stable, pair[1], "ours")))
        bars.append(
            Bar(
                GROUP,
                f"{who}: {WITH} at most half of {WITHOUT}",
                pair,
                partial(_judge_moved, *pair),
            )
        )
        bars.append(Bar(GROUP, f"{who}: P costs at most {COST_PX} px", pair, partial(_judge_cost, *pair)))
    return bars


def _judge_stable(run: Held, who: str, results: Results) -> Verdict:
    found = results[run]
    if not found["held"]:
        raise NotMeasured(f"{run.sequence}: the hand carries the object in none of {found['frames']} frames.")
    count, held = found[who]["stable"], found["held"]
    words = f"{count} of {held} frames ({found[who]['points_stable']} between points, as SD-obman has it)"
    return Verdict(words, count >= STABLE_SHARE * held, note=NOTE)


def _judge_moved(without: Held, with_it: Held, results: Results) -> Verdict:
    before, after = results[without], results[with_it]
    if not before["held"]:
        raise NotMeasured(f"{without.sequence}: the hand carries the object in none of {before['frames']} frames.")
    first, second = before["ours"], after["ours"]
    words = (
        f"{first['mean_mm']:.2f} to {second['mean_mm']:.2f} mm (median {first['median_mm']:.2f} to "
        f"{second['median_mm']:.2f}; truth {before['truth']['mean_mm']:.2f})"
    )
    share = second["mean_mm"] / first["mean_mm"]
    return Verdict(words, share <= SHARE, share / SHARE, NOTE)


def _judge_cost(without: Held, with_it: Held, results: Results) -> Verdict:
    before, after = results[without]["px"], results[with_it]["px"]
    return at_most(after - before, COST_PX, f"{before:.3f} to {after:.3f} px")
