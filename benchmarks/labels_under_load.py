"""Fifty annotators on a network that is late by 0 to 3 s and breaks, with the studio killed twice; about 7 minutes.

    python -m benchmarks.labels_under_load [--seconds 300] [--browsers 8] [--write]

Some of the annotators sit at real Chromiums, press a key that moves and click at once. Every picture carries its
number, so what was on the screen at a click is read from the screen's own pixels. The others are simulated
(`handloom bench server`). `--write` writes `benchmarks/results/labels_under_load.md`.
"""

from __future__ import annotations

import argparse
import asyncio
import random
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from benchmarks.load.bystander import stand_by
from benchmarks.load.other_computers import sit_elsewhere
from benchmarks.load.slow_network import SlowNetwork
from benchmarks.load.stored import Judgement, judge
from benchmarks.result_page import write_result
from server.cli.bench_server import ServedStudio, annotations_of, write_recording
from server.cli.simulated_annotators import Ledger, annotate_together, find_faults

FRAMES, OF_ONE_BROWSER, OF_BYSTANDER = 10_000, 200, 20
KILLS, OUTAGES, OUTAGE_SECONDS = 2, 4, 5.0
REST_SECONDS = 20.0
"""So long after an outage everybody's page saves and loads at once."""


async def work(studio: ServedStudio, recording: dict[str, Any], args: argparse.Namespace) -> dict[str, Any]:
    """All of it: people at work, a network and a studio that fail them, and what is stored afterwards."""
    simulated = args.annotators - args.browsers
    own = FRAMES - args.browsers * OF_ONE_BROWSER
    theirs = own - OF_BYSTANDER
    base = annotations_of(recording["id"])
    async with SlowNetwork(studio.url, args.latency, args.cut, random.Random(args.seed)) as network:
        url = f"{network.url}/recordings/{recording['id']}/annotate"
        people = asyncio.create_task(sit_elsewhere(url, range(own, FRAMES), OF_ONE_BROWSER, args.seconds, args.seed))
        ledger, bystander, _ = await asyncio.gather(
            annotate_together(network.url, base, theirs, simulated, args.seconds, 1.0, args.seed),
            stand_by(studio.url, base, range(theirs, own), args.seconds, args.seed),
            _trouble(studio, network, args.seconds),
        )
        network.latency = network.cut_part = 0.0
        seen = await people
    judged = await asyncio.to_thread(judge, studio.url, base, range(own, FRAMES), seen.gestures)
    faults = [fault for one in (ledger, bystander) for fault in await asyncio.to_thread(find_faults, studio.url, one)]
    result = describe(network, ledger, bystander, judged, faults, studio, args)
    if judged.lost:
        result["faults"] += seen.opened
    return result


async def _trouble(studio: ServedStudio, network: SlowNetwork, seconds: float) -> None:
    """Outages of the network and kills of the studio, spread over the time."""
    moments = [(k + 1) / (OUTAGES + 1) for k in range(OUTAGES)] + [(k + 0.6) / (KILLS + 0.5) for k in range(KILLS)]
    kills = set(moments[OUTAGES:])
    began = time.monotonic()
    for moment in sorted(moments):
        await asyncio.sleep(max(0.0, began + moment * seconds - time.monotonic()))
        if moment in kills:
            await asyncio.to_thread(studio.kill_and_restart)
            network.mended.append(time.monotonic())
        else:
            await network.go_down(OUTAGE_SECONDS)


def describe(
    network: SlowNetwork,
    ledger: Ledger,
    bystander: Ledger,
    judged: Judgement,
    faults: list[str],
    studio: ServedStudio,
    args: argparse.Namespace,
) -> dict[str, Any]:
    """The figures."""
    saves = [
        one for one in network.answered if one.method == "PUT" and "/annotations/" in one.path and one.status < 500
    ]
    seen = sorted(1e3 * one.seconds for one in saves)
    calm = sorted(1e3 * one.seconds for one in saves if not any(0 <= one.at - m < REST_SECONDS for m in network.mended))
    times = sorted(1e3 * seconds for seconds in bystander.seconds)
    return {
        "annotators": f"{args.annotators}, {args.browsers} of them at browsers",
        "seconds": args.seconds,
        "latency s": f"0 to {args.latency:g}",
        "requests": len(network.answered),
        "requests cut": network.cuts,
        "studio killed": studio.starts - 1,
        "gestures of simulated annotators acknowledged": len({one.operation_id for one in ledger.acknowledged}),
        "clicks at browsers taken": judged.taken,
        "clicks at browsers not taken": judged.refused,
        f"{len(times)} saves of a bystander, median ms of the server's own time": round(times[len(times) // 2], 1),
        "saves of the bystander, 95 % ms": round(times[int(0.95 * len(times))], 1),
        "saves of the bystander, 99 % ms": round(times[int(0.99 * len(times))], 1),
        "as the busy network saw them: median ms": round(seen[len(seen) // 2], 1),
        "as the busy network saw them: 95 % ms": round(seen[int(0.95 * len(seen))], 1),
        f"the same but for {REST_SECONDS:g} s after each outage, 95 % ms": round(calm[int(0.95 * len(calm))], 1),
        "simulated: lost or double": len(faults),
        "browsers: lost": len(judged.lost),
        "browsers: on another frame than the one shown": len(judged.elsewhere),
        "faults": [*faults, *judged.lost, *judged.elsewhere],
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--annotators", type=int, default=50, help="in all (50)")
    parser.add_argument("--browsers", type=int, default=8, help="of them at real browsers (8)")
    parser.add_argument("--seconds", type=float, default=300, help="how long (300)")
    parser.add_argument("--latency", type=float, default=3.0, help="each request is late by up to this, s (3)")
    parser.add_argument("--cut", type=float, default=0.02, help="part of the requests that are cut (0.02)")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--write", action="store_true", help="write benchmarks/results/labels_under_load.md")
    args = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="handloom-load-") as folder:
        path = write_recording(Path(folder) / "recording", FRAMES, 40_000)
        studio = ServedStudio(Path(folder) / "data", None, with_worker=False)
        recording = studio.command("import", str(path), "--json")
        with studio:
            result = asyncio.run(work(studio, recording, args))
    faults = result.pop("faults")
    table = "\n".join(["| figure | value |", "|---|---|", *(f"| {name} | {value} |" for name, value in result.items())])
    print(table)
    for fault in faults[:60]:
        print(fault)
    if args.write:
        command = "python -m benchmarks.labels_under_load --write"
        write_result("labels_under_load", "Annotators at real browsers on a bad network", command, table)
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
