"""What the presets of a tracking job cost: `python -m benchmarks.presets FOLDER_OF_T16_DATA`.

Twins of two public sequences, the authors' models, with `t16` their full meshes, one thread: 09 (one hand) and 17 (two
hands and a pipe).
"""

from __future__ import annotations

import argparse
import logging
from pathlib import Path
from typing import Any

from benchmarks.studies.twin_runs import Run
from tracker.fitting.presets import PRESETS, TrackPreset

log = logging.getLogger("presets")

SEQUENCES = ("09", "17")


def main() -> None:
    """Print a row of the table in docs/tracking.md for each preset and sequence."""
    parser = argparse.ArgumentParser(description=main.__doc__)
    parser.add_argument("data", type=Path, help="the authors' folder with the sequences")
    parser.add_argument("--frames", type=int, default=60, help="frames of each sequence (60)")
    parser.add_argument("--repeats", type=int, default=3, help="runs of each, of which the quickest counts (3)")
    parser.add_argument("--cache", type=Path, default=Path("build/twins"), help="where rendered twins are kept")
    args = parser.parse_args()
    logging.basicConfig(level=logging.INFO, format="%(message)s")
    log.info("| preset | sequence | median ms | 95 % ms | mean px | mean mm | lost |")
    log.info("|---|---|---|---|---|---|---|")
    for name in SEQUENCES:
        # In turns, so that a busy moment of the machine does not fall on one preset alone.
        runs = [[_run(args, name, preset) for preset in PRESETS] for _ in range(args.repeats)]
        for place, preset in enumerate(PRESETS):
            found = min((turn[place] for turn in runs), key=lambda one: one["median_ms"])
            figures = [f"{found[key]:.1f}" for key in ("median_ms", "p95_ms")] + [
                f"{found['px']:.2f}",
                f"{found['mm']:.2f}",
            ]
            log.info("| %s | %s | %s | %d |", preset.label, name, " | ".join(figures), found["lost"])


def _run(args: argparse.Namespace, name: str, preset: TrackPreset) -> dict[str, Any]:
    values = {option: value for option, value in preset.values.items() if option != "calibrate"}
    run = Run(name, frames=args.frames, **values)
    return run(args.data, args.cache)


if __name__ == "__main__":
    main()
