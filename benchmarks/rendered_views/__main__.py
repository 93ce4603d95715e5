"""[T16] §4.4.1 on two rendered recordings: `python -m benchmarks.rendered_views [crossing passing] [--write]`.

Every run is kept in the folder `--work` and not done again. `--write` writes `benchmarks/results/rendered_views.md`
from all runs of both recordings that the folder holds.
"""

from __future__ import annotations

import argparse
import os
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: one thread is measured

import numpy as np  # noqa: E402

from benchmarks.rendered_views.errors import Errors  # noqa: E402
from benchmarks.rendered_views.follow import follow  # noqa: E402
from benchmarks.rendered_views.page import PAGE, list_settings, write_page  # noqa: E402
from benchmarks.rendered_views.setting import Setting  # noqa: E402
from benchmarks.rendered_views.shown import MOMENTS, SIZE, Shown, show  # noqa: E402
from tracker.synthesis.interplay import INTERPLAYS  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]


def run(shown: Shown, setting: Setting, work: Path) -> None:
    """Follow, unless that was done before, and say how exactly."""
    kept = work / "runs" / shown.sequence.folder.name / f"{setting.key}.npz"
    if not kept.exists():
        kept.parent.mkdir(parents=True, exist_ok=True)
        found, true_ball = follow(shown, setting), shown.truth.T_world_object[:, :, :3, 3]
        np.savez(
            kept,
            joints=found.joints,
            ball=found.ball,
            ball_score=found.ball_score,
            seconds=found.seconds,
            truth=shown.truth.joints_3d,
            true_ball=true_ball,
        )
    stored = np.load(kept)
    errors = Errors.of(stored["joints"], stored["truth"])
    apart = 1000.0 * np.linalg.norm(stored["ball"] - stored["true_ball"], axis=2)
    ball = f", ball {apart.mean():.2f} mm, max {apart.max():.1f}" if apart.size else ""
    print(
        f"{shown.name} {setting.key}: mean {errors.mm.mean():.2f} mm, max {errors.mm.max():.1f}, "
        f"{errors.degrees.mean():.2f} deg{ball}, median {1000 * np.median(stored['seconds']):.0f} ms",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", default=list(INTERPLAYS), help="crossing, passing or both")
    parser.add_argument("--work", type=Path, default=ROOT / "out" / "rendered_views")
    parser.add_argument("--moments", type=int, default=MOMENTS)
    parser.add_argument("--size", type=int, nargs=2, default=SIZE)
    parser.add_argument("--only", default="", help="settings whose name contains this")
    parser.add_argument("--write", action="store_true", help="write the page")
    given = parser.parse_args()
    size = given.size[0], given.size[1]
    for name in given.names:
        shown = show(name, given.work, given.moments, size)
        for setting in list_settings():
            if given.only in setting.key:
                run(shown, setting, given.work)
    if given.write:
        PAGE.write_text(write_page(given.work / "runs", given.moments, size))


if __name__ == "__main__":
    main()
