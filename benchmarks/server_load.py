"""Fifty annotators, a tracking job beside one, and a studio that is killed again and again; about 13 minutes.

    python -m benchmarks.server_load [--seconds 300] [--write]

Every case is `handloom bench server` with other options. PostgreSQL is started here, with commits that wait for the
disk. `--write` writes `benchmarks/results/server_load.md`.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
from typing import Any

import psycopg

from benchmarks.result_page import write_result
from tests.postgres import run_postgres

HEADS = (
    "what",
    "database",
    "gestures",
    "median ms",
    "95 % ms",
    "99 % ms",
    "worst ms",
    "met another's",
    "sent again",
    "killed",
    "lost or double",
)


def measure(name: str, *options: str) -> dict[str, Any]:
    """One case; a fault makes the command fail, but its figures are printed all the same."""
    command = [sys.executable, "-m", "server.cli", "bench", "server", "--json", *options]
    done = subprocess.run(command, capture_output=True, text=True)
    if not done.stdout:
        sys.exit(f"{name}: {done.stderr}")
    result = json.loads(done.stdout)
    print(
        f"{name}, {result['database']}: 95 % within {result['p95_ms']} ms, {len(result['faults'])} faults", flush=True
    )
    for fault in result["faults"][:5]:
        print(f"  {fault}")
    return result | {"what": name}


def row(result: dict[str, Any]) -> str:
    """A line of the table."""
    cells = [result[key] for key in ("what", "database", "gestures", "median_ms", "p95_ms", "p99_ms", "max_ms")]
    cells += [result["conflicts"], result["sent_again"], result["restarts"], len(result["faults"])]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=300, help="of the cases with fifty annotators (300)")
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/server_load.md")
    args = parser.parse_args()
    seconds = ("--seconds", str(args.seconds))
    results = []
    with run_postgres(is_durable=True) as server:
        with psycopg.connect(f"{server}/postgres", autocommit=True) as connection:
            connection.execute("CREATE DATABASE fifty")
            connection.execute("CREATE DATABASE killed")
        killed = ("--annotators", "20", "--seconds", str(args.seconds / 5), "--kill-every", "12")
        small = ("--frames", "2000", "--joints", "40000")
        for database in ((), ("--database", f"{server}/fifty")):
            results.append(measure("50 annotators", *seconds, *database))
        one = ("--annotators", "1", "--pause", "0.2", "--seconds", "15")
        results.append(measure("1 annotator, a tracking job beside", *one, *small, "--tracking"))
        for database in ((), ("--database", f"{server}/killed")):
            results.append(measure("20 annotators, studio killed", *killed, *small, *database))
    table = "\n".join(["| " + " | ".join(HEADS) + " |", "|" + "---|" * len(HEADS), *map(row, results)])
    print(table)
    if args.write:
        write_result("server_load", "Saving under load", "python -m benchmarks.server_load --write", table)


if __name__ == "__main__":
    main()
