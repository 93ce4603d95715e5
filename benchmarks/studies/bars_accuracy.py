"""Bars on the error: the known model at every frame, every third and every fifth, and with each term."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

from benchmarks.studies.bar import Bar, Verdict, at_most, none_of
from benchmarks.studies.study import HAND_OBJECT, Extent
from benchmarks.studies.trial import Results, Trial
from benchmarks.studies.true_penetration import TruePenetration
from benchmarks.studies.twin_runs import SEQUENCES, Run
from tracker.fitting.options import TrackOptions

DEFAULT = TrackOptions().terms
"""What a run has that asks for nothing else."""

MEANS_PX = {
    "one hand": (("09", "12"), 0.6),
    "two hands": (("01", "04"), 0.5),
    "with an object": (("15", "17", "20"), 0.6),
}
ROPE_PX, WORST_MM, THIRD_PX = 1.0, 6.0, 0.8
OBJECTS_MM = {"ball": ("15", 1.0), "cube": ("20", 1.0), "pipe": ("17", 2.0), "rope": ("18", 4.0)}
TERM_PX, PENETRATION_MM = 0.05, 1.0
PAIRS = (("C", "LO", "LO+C"), ("S", "LO", "LO+S"), ("S beside C", "LO+C", "LO+SC"), ("P", "LO+C", "LO+CP"))


def run_of(name: str, step: int, extent: Extent, terms: str = DEFAULT, own: bool = False) -> Run:
    """The tracker as it comes, on one sequence."""
    return Run(name, step, extent.frames, terms, own_hand=own, penetration=True)


def own_hand_sequences(extent: Extent) -> Sequence[str]:
    """Those that are followed with our own hand, whose calibration takes most of a short run."""
    return ("09", "15") if extent.quick else SEQUENCES


def list_accuracy_bars(extent: Extent) -> list[Bar]:
    """All of them, in the order of the project's table."""
    every = {name: run_of(name, 1, extent) for name in SEQUENCES}
    group = f"same model, every frame ({DEFAULT})"
    bars = [
        _mean_bar(group, f"{what} ({', '.join(names)}): mean at most {limit} px", [every[n] for n in names], limit)
        for what, (names, limit) in MEANS_PX.items()
    ]
    whole = list(every.values())
    bars += [
        _mean_bar(group, f"rope (18): mean at most {ROPE_PX} px", [every["18"]], ROPE_PX),
        Bar(group, f"worst frame of any hand at most {WORST_MM:.0f} mm", whole, partial(_judge_worst, whole)),
        *(
            Bar(group, f"{name} ({of}) at most {mm:.0f} mm", [every[of]], partial(_judge_object, every[of], mm))
            for name, (of, mm) in OBJECTS_MM.items()
        ),
        Bar(group, "none lost", whole, partial(_judge_lost, whole)),
    ]
    thirds, fifths = ([run_of(name, step, extent) for name in SEQUENCES] for step in (3, 5))
    bars += [
        _mean_bar("same model, every 3rd frame", f"mean at most {THIRD_PX} px", thirds, THIRD_PX),
        Bar("same model, every 3rd frame", "none lost", thirds, partial(_judge_lost, thirds)),
        Bar("same model, every 5th frame", "none lost", fifths, partial(_judge_lost, fifths)),
    ]
    return bars


def list_term_bars(extent: Extent) -> list[Bar]:
    """Each term against the run without it, and penetration with C."""
    bars = []
    for own, step, whose in ((False, 1, "same model, every frame"), (True, 3, "own hand, every 3rd frame")):
        all_of = own_hand_sequences(extent) if own else SEQUENCES
        for name, without, with_it in PAIRS:
            names = [n for n in all_of if n in HAND_OBJECT] if name == "P" else all_of
            both = [tuple(run_of(n, step, extent, terms, own) for terms in (without, with_it)) for n in names]
            bars.append(
                Bar(
                    f"each term, {whose}",
                    f"{name}: {with_it} against {without}, nowhere above it by more than {TERM_PX} px",
                    [run for pair in both for run in pair],
                    partial(_judge_term, both),
                )
            )
        runs = [run_of(n, step, extent, "LO+C", own) for n in all_of]
        truths = [TruePenetration(n, step, extent.frames) for n in all_of]
        bars.append(
            Bar(
                f"each term, {whose}",
                f"deepest penetration with C at most the truth's own and {PENETRATION_MM:.0f} mm",
                [*runs, *truths],
                partial(_judge_penetration, runs, truths),
            )
        )
    return bars


def _mean_bar(group: str, what: str, runs: Sequence[Run], limit: float) -> Bar:
    return Bar(group, what, runs, partial(_judge_mean, runs, limit))


def show_each(runs: Sequence[Run], values: Sequence[float], unit: str, digits: int = 2) -> str:
    """Sequence and value, one after another."""
    return (
        ", ".join(f"{run.sequence}: {value:.{digits}f}" for run, value in zip(runs, values, strict=True)) + f" {unit}"
    )


def _judge_mean(runs: Sequence[Run], limit: float, results: Results) -> Verdict:
    means = [results[run]["px"] for run in runs]
    still = [run for run in runs if 0 < results[run]["moving_frames"] < results[run]["frames"] - 1]
    notes = [f"{run.sequence} from its first motion on: {results[run]['moving_px']:.2f} px." for run in still]
    return at_most(max(means), limit, show_each(runs, means, "px"), " ".join(notes))


def _judge_worst(runs: Sequence[Run], results: Results) -> Verdict:
    worst = [results[run]["worst_mm"] for run in runs]
    return at_most(max(worst), WORST_MM, show_each(runs, worst, "mm", 1))


def _judge_object(run: Run, limit: float, results: Results) -> Verdict:
    (item,) = results[run]["objects"].values()
    words = f"{item['mm']:.2f} mm (worst frame {item['worst_mm']:.1f}, surface {item['surface_mm']:.2f})"
    return at_most(item["mm"], limit, words)


def _judge_lost(runs: Sequence[Run], results: Results) -> Verdict:
    lost: list[dict[str, Any]] = [results[run] for run in runs]
    count = sum(found["lost"] for found in lost)
    silent = sum(found["silent"] for found in lost)
    where = ", ".join(f"{f['sequence']}: {f['lost']}" for f in lost if f["lost"])
    frames = sum(found["frames"] for found in lost)
    return none_of(count, f"{count} of {frames} frames{f' ({where}; {silent} unnoticed)' if count else ''}")


def _judge_term(both: Sequence[tuple[Run, ...]], results: Results) -> Verdict:
    change = [results[with_it]["px"] - results[without]["px"] for without, with_it in both]
    words = ", ".join(f"{pair[0].sequence}: {value:+.3f}" for pair, value in zip(both, change, strict=True))
    return Verdict(f"{words} px", max(change) <= TERM_PX, max(0.0, max(change)) / TERM_PX)


def _judge_penetration(runs: Sequence[Run], truths: Sequence[Trial], results: Results) -> Verdict:
    deepest = [results[run]["deepest_mm"] for run in runs]
    true = [results[trial]["deepest_mm"] for trial in truths]
    words = ", ".join(f"{run.sequence}: {own:.1f} ({of:.1f})" for run, own, of in zip(runs, deepest, true, strict=True))
    over = max(own - of for own, of in zip(deepest, true, strict=True))
    return Verdict(f"{words} mm (truth)", over <= PENETRATION_MM, max(0.0, over) / PENETRATION_MM)
