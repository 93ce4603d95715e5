"""Run studies and write their report: `python -m benchmarks.studies DATA [--only table_03 bars] [--quick] [--write]`.

DATA holds the authors' `Cameras.txt`, `models/` and `seq/`. Results are kept in the cache as they come, so a run that
was stopped goes on, and only what other code made is run anew. The report is written into the cache, with `--write`
into `benchmarks/results`.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from pathlib import Path

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
    os.environ.setdefault(name, "1")  # before numpy: every process measures one thread

from benchmarks.studies.catalogue import STUDIES  # noqa: E402
from benchmarks.studies.report import StudyRows, load_all_rows, write_report  # noqa: E402
from benchmarks.studies.study import Extent, Study  # noqa: E402
from benchmarks.studies.trial import ROOT, NotMeasured, Results, load_kept, run_trials  # noqa: E402

RESULTS = ROOT / "benchmarks" / "results"
ROWS = RESULTS / "studies" / "rows"


def make_rows(study: Study, extent: Extent, runs: Path) -> StudyRows:
    """The rows of a study from the results that are kept.

    Raises:
        NotMeasured: One of its trials was not run, or failed.
    """
    rows = study.tabulate(Results(runs), extent)
    kept = [load_kept(trial, runs) for trial in study.trials(extent)]
    return StudyRows(study.name, extent.quick, sorted({one.code for one in kept if one and not one.error}), rows)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--only", nargs="+", choices=[study.name for study in STUDIES], metavar="STUDY")
    parser.add_argument("--quick", action="store_true", help="the first 40 frames of each sequence, to try it out")
    parser.add_argument("--cache", type=Path, default=ROOT / "out" / "studies", help="of results (out/studies)")
    parser.add_argument("--twins", type=Path, help="of rendered twins (twins in the cache)")
    parser.add_argument("--processes", type=int, default=2, help="trials at a time (2); those of time run alone")
    parser.add_argument("--keep", action="store_true", help="take results of older code, run only what is missing")
    parser.add_argument(
        "--report", action="store_true", help="run nothing, build the report from rows in the cache or results"
    )
    parser.add_argument("--write", action="store_true", help="write the report and its rows into benchmarks/results")
    args = parser.parse_args()
    chosen = [study for study in STUDIES if args.only is None or study.name in args.only]
    extent, runs, began = Extent(args.quick), args.cache / "runs", time.perf_counter()
    rows_folder = args.cache / ("rows_quick" if args.quick else "rows")
    failed = False
    if not args.report:
        trials = [trial for study in chosen for trial in study.trials(extent)]
        run_trials(trials, args.data, args.twins or args.cache / "twins", runs, args.processes, args.keep)
        for study in chosen:
            try:
                make_rows(study, extent, runs).save(rows_folder)
            except NotMeasured as problem:
                failed = True
                print(f"{study.name}: {problem}", file=sys.stderr)
    sources = (rows_folder, ROWS) if args.report else (rows_folder,)
    rows = load_all_rows(STUDIES, *sources)
    if args.write:
        for own in rows.values():
            own.save(ROWS)
    written = write_report(STUDIES, rows, RESULTS if args.write else args.cache / "report")
    size = sum(path.stat().st_size for path in written)
    print(
        f"{written[0]} and {len(written) - 1} files beside it, {size / 1e3:.0f} kB, {time.perf_counter() - began:.0f} s"
    )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
