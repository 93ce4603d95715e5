"""Bars on time, memory and repetition."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from benchmarks.studies.bar import Bar, Verdict, at_most
from benchmarks.studies.memory import Memory
from benchmarks.studies.study import Extent
from benchmarks.studies.trial import ROOT, NotMeasured, Results
from benchmarks.studies.twin_runs import Run, render_twin, run_twin, start_twin
from tracker.fitting.options import TrackOptions

ONE_MS, ONE_RATIO, TWO_MS, TWO_THREADS_MS, PHYSICS_MS = 15.0, 1.4, 32.0, 20.0, 60.0
MEMORY_FRAMES, MEMORY_MB, GROWTH_MB = 1500, 600.0, 20.0
NOISY = "Upper bounds: the machine has two cores and other work on them."


@dataclass(frozen=True)
class Timed(Run):
    """A run whose times count: nothing else of the studies runs beside it."""

    alone: ClassVar[bool] = True


@dataclass(frozen=True)
class Bench:
    """What `handloom bench tracking --json` prints on a twin: medians and the sum of isolated kernels."""

    tracked: int
    alone: ClassVar[bool] = True

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Run the command."""
        command = [sys.executable, "-m", "tracker.cli", "bench", "tracking", "--json", "--twin", str(data)]
        command += ["--frames", str(self.tracked)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        return json.loads(done.stdout)


@dataclass(frozen=True)
class Repeated:
    """The first frames of a sequence tracked twice from the same state."""

    sequence: str
    frames: int
    terms: str

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Whether poses are the same to the last bit."""
        twin = render_twin(data, twins, self.sequence, self.frames, 1, 0)
        setup, state = start_twin(twin, TrackOptions(terms=self.terms, calibrate=False))
        first, second = (run_twin(twin, setup, state).pose for _ in range(2))
        return {"frames": len(first), "is_same": bool(np.array_equal(first, second))}


def list_cost_bars(extent: Extent) -> list[Bar]:
    """All of them."""
    one = Timed("09", 1, extent.frames, "LO+SC")
    two = Timed("04", 1, extent.frames, "LO+SC")
    threads = Timed("04", 1, extent.frames, "LO+SC", threads=2)
    held = [Timed(name, 1, extent.frames or 120, "LO+SCP") for name in ("17", "18")]
    bench = Bench(20 if extent.quick else 60)
    memory = Memory(60 if extent.quick else MEMORY_FRAMES)
    repeated = [Repeated(name, 30, terms) for name, terms in (("04", "LO+SC"), ("20", "LO+SCP"))]
    group = "time, 640x480, 10 iterations"
    return [
        Bar(group, f"one hand LO+SC, one thread: median at most {ONE_MS:.0f} ms", [one], partial(_ms, one, ONE_MS)),
        Bar(group, f"the same over its isolated kernels at most {ONE_RATIO}", [bench], partial(_ratio, bench)),
        Bar(group, f"two hands LO+SC, one thread: at most {TWO_MS:.0f} ms", [two], partial(_ms, two, TWO_MS)),
        Bar(
            group,
            f"two hands LO+SC, two threads: at most {TWO_THREADS_MS:.0f} ms",
            [threads],
            partial(_ms, threads, TWO_THREADS_MS),
        ),
        *(
            Bar(
                group,
                f"two hands and object ({run.sequence}), LO+SCP: at most {PHYSICS_MS:.0f} ms",
                [run],
                partial(_ms, run, PHYSICS_MS),
            )
            for run in held
        ),
        Bar("memory", f"flat over 1,500 frames, at most {MEMORY_MB:.0f} MB", [memory], partial(_memory, memory)),
        Bar("repetition", "same input, same result to the last bit", repeated, partial(_same, repeated)),
    ]


def _ms(run: Run, limit: float, results: Results) -> Verdict:
    found = results[run]
    words = f"{found['median_ms']:.1f} ms (p95 {found['p95_ms']:.1f}), {found['px']:.2f} px"
    return at_most(found["median_ms"], limit, words, NOISY)


def _ratio(bench: Bench, results: Results) -> Verdict:
    found = results[bench]["one_hand"]
    if not found.get("floor_ms"):
        raise NotMeasured("`handloom bench tracking` printed no floor_ms.")
    ratio = found["median_ms"] / found["floor_ms"]
    return at_most(ratio, ONE_RATIO, f"{ratio:.2f} ({found['median_ms']:.1f} over {found['floor_ms']:.1f} ms)")


def _memory(memory: Memory, results: Results) -> Verdict:
    found = results[memory]["megabytes"]
    settled = found[min(2, len(found) - 1)]
    words = f"{settled:.0f} MB after {2 * results[memory]['every']} frames, {found[-1]:.0f} at the end"
    is_met = max(found) <= MEMORY_MB and found[-1] - settled <= GROWTH_MB
    return Verdict(words, is_met, max(found) / MEMORY_MB, f"Flat: at most {GROWTH_MB:.0f} MB more.")


def _same(repeated: list[Repeated], results: Results) -> Verdict:
    is_same = all(results[trial]["is_same"] for trial in repeated)
    words = f"{'the same' if is_same else 'different'} poses ({', '.join(trial.sequence for trial in repeated)})"
    return Verdict(words, is_same)
