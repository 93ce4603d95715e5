"""Halve and double each number of the rooms that follow hands: `python -m benchmarks.constants DATA [--write]`.

DATA holds the real recordings. A number that no run reads is not changed, nor, without `--kernels`, one of a module
with kernels, which are then compiled anew for two minutes. What was measured is kept in the cache, so a run that was
stopped goes on; delete the cache after the tracker has changed. With `--write` the table goes into
`benchmarks/results/constants.md`.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from benchmarks.constants.numbers import ROOMS, ROOT, Number, list_numbers
from benchmarks.constants.table import Outcome, write_table
from benchmarks.constants.trial import FRAMES, RECORDINGS
from benchmarks.result_page import write_result
from tracker.capture.atomic_file import write_atomically

FACTORS = (2.0, 0.5)

HOW_TO_READ = """Half and double give differences from these figures (right: more is better), and processor time as a
ratio, which wanders by a quarter on a busy machine. Counts stay whole. *Not read*: these recordings do not need the
number, which belongs to several views, colour alone, objects, the fit of a hand's shape, or a case that does not arise.
*Kernel*: `--kernels` changes it."""


def run(data: Path, cache: Path, number: Number | None, factor: float = 1.0) -> None:
    """Measure once and keep it; a run that fails is kept with the last line of what it said."""
    kept = cache / f"{name_run(number, factor)}.json"
    if kept.exists():
        return
    began, arguments = time.perf_counter(), [str(data), str(cache / "recordings")]
    with tempfile.TemporaryDirectory() as kernels:
        if number is not None:
            arguments += [number.module, number.name, repr(number.times(factor))]
        done = call(arguments, kernels if number is not None and number.is_compiled else None)
    result = json.loads(done.stdout.splitlines()[-1]) if done.returncode == 0 else done.stderr.splitlines()[-1][:200]
    write_atomically(kept, json.dumps(result).encode())
    print(f"{kept.stem}  {time.perf_counter() - began:.0f} s", flush=True)


def call(arguments: list[str], kernels: str | None) -> subprocess.CompletedProcess[str]:
    """The trial in a process of its own, with kernels compiled anew where their numbers are others."""
    own = {"NUMBA_CACHE_DIR": kernels} if kernels else {}
    command = [sys.executable, "-m", "benchmarks.constants.trial", *arguments]
    return subprocess.run(command, env={**os.environ, **own}, cwd=ROOT, capture_output=True, text=True)


def name_run(number: Number | None, factor: float) -> str:
    return "as it is" if number is None else f"{number.module}.{number.name} x {factor:g}"


def find_reached(data: Path, cache: Path) -> list[Number]:
    """The numbers that a run reads."""
    kept = cache / "reached.json"
    if not kept.exists():
        done = call([str(data), str(cache / "recordings"), "reached"], None)
        done.check_returncode()
        write_atomically(kept, done.stdout.splitlines()[-1].encode())
    reached = {tuple(pair) for pair in json.loads(kept.read_text())}
    return [one for one in list_numbers() if (one.module, one.name) in reached]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("data", type=Path)
    parser.add_argument("--cache", type=Path, default=ROOT / "out" / "constants")
    parser.add_argument("--processes", type=int, default=2, help="runs at a time (2)")
    parser.add_argument("--kernels", action="store_true", help="change the numbers of modules with kernels too")
    parser.add_argument("--write", action="store_true", help="write the table into benchmarks/results")
    args = parser.parse_args()
    args.cache.mkdir(parents=True, exist_ok=True)
    run(args.data, args.cache, None)
    reached = [one for one in find_reached(args.data, args.cache) if args.kernels or not one.is_compiled]
    wanted = [(number, factor) for factor in FACTORS for number in reached]
    print(f"{len(list_numbers())} numbers, {len(wanted)} runs", flush=True)
    with ThreadPoolExecutor(args.processes) as pool:
        list(pool.map(lambda pair: run(args.data, args.cache, *pair), wanted))
    text = report(args.cache, wanted)
    print(text)
    if args.write:
        write_result("constants", "Each number halved and doubled", "python -m benchmarks.constants DATA --write", text)


def report(cache: Path, wanted: list[tuple[Number, float]]) -> str:
    """What the runs in the cache came to."""
    usual = Outcome.load(cache / "as it is.json")
    found = {pair: Outcome.load(cache / f"{name_run(*pair)}.json") for pair in wanted}
    numbers, changed = list_numbers(), {number for number, _ in wanted}
    same = [one for one in changed if all(found[one, factor].is_same(usual) for factor in FACTORS)]
    counts = (
        f"The first {FRAMES} frames of {', '.join(RECORDINGS)}, tracked with the default hand: {usual.right} of "
        f"{usual.tips} fingertips right, {usual.lost} frames lost, {usual.wrong} called ok with a fingertip in a wrong "
        f"place. Of {len(numbers)} numbers in the rooms {', '.join(ROOMS)}, {len(changed)} were changed; {len(same)} "
        "of these move not one pose when they are halved or doubled."
    )
    return f"{counts}\n\n{HOW_TO_READ}\n\n{write_table(numbers, usual, found)}"


if __name__ == "__main__":
    main()
