"""`handloom bench server`: how fast and how safely the studio saves while many people annotate."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import httpx

from server.cli.guarded import FAILED, CommandError, add_json, answer, run_guarded
from server.cli.simulated_annotators import JOINTS, SHARED_FRAMES, annotate_together, find_faults

CAMERA = "cam0"
WIDTH, HEIGHT = 64, 48
BITS, STRIPE = 14, 4
"""A frame's number stands in its picture: so many bits, the lowest first, each so many px wide and twice as tall."""

START_SECONDS = 120.0


def add_subject(subjects: argparse._SubParsersAction) -> None:
    """Add `server` to `handloom bench`."""
    parser = subjects.add_parser(
        "server",
        help="how fast and how safely the studio saves",
        description="Serve a studio of its own in a temporary folder and have simulated annotators save a gesture "
        "every second or so, some on the same frames; then check that the history holds every acknowledged gesture.",
    )
    parser.add_argument("--annotators", type=int, default=50, metavar="N", help="people at once (50)")
    parser.add_argument("--seconds", type=float, default=60, metavar="S", help="how long (60)")
    parser.add_argument("--pause", type=float, default=1.0, metavar="S", help="mean time between gestures (1)")
    parser.add_argument("--frames", type=int, default=10_000, metavar="N", help="frames of the recording (10,000)")
    parser.add_argument("--joints", type=int, default=200_000, metavar="N", help="joints stored beforehand (200,000)")
    parser.add_argument("--database", metavar="URL", help="an empty PostgreSQL database (SQLite otherwise)")
    parser.add_argument(
        "--kill-every", type=float, metavar="S", help="kill -9 the studio this often, and start it again"
    )
    parser.add_argument("--listeners", type=int, default=0, metavar="N", help="pages that listen to every save (0)")
    parser.add_argument("--tracking", action="store_true", help="track a recording at the same time")
    add_json(parser)
    parser.set_defaults(run=run_guarded(run))


def run(args: argparse.Namespace) -> int:
    for name, least in (("annotators", 1), ("seconds", 0.1), ("frames", 100), ("joints", 0), ("pause", 0.001)):
        if getattr(args, name) < least:
            raise CommandError(f"--{name} {getattr(args, name)}: needed at least {least}.")
    if args.frames < (least := args.annotators + SHARED_FRAMES):
        raise CommandError(
            f"--frames {args.frames}: needed at least {least}, one for each of {args.annotators} annotators and "
            f"{SHARED_FRAMES} that they share."
        )
    with tempfile.TemporaryDirectory(prefix="handloom-bench-") as folder:
        result = bench(Path(folder), args)
    answer(args, result, show(result))
    return FAILED if result["faults"] else 0


def bench(folder: Path, args: argparse.Namespace) -> dict[str, Any]:
    """Measure in an empty folder."""
    recording = write_recording(folder / "recording", args.frames, args.joints)
    studio = ServedStudio(folder / "data", args.database, with_worker=args.tracking)
    sequence = studio.command("import", str(recording), "--json")["id"]
    with studio:
        with contextlib.ExitStack() as stack:
            if args.tracking:
                stack.enter_context(_tracking(studio, folder / "tracked"))
            before = studio.read_processor_seconds()
            ledger = asyncio.run(_annotate(studio, sequence, args))
            after = studio.read_processor_seconds()
        faults = find_faults(studio.url, ledger)
    times = sorted(1e3 * seconds for seconds in ledger.seconds)
    return {
        "database": "postgresql" if args.database else "sqlite",
        "annotators": args.annotators,
        "seconds": args.seconds,
        "frames": args.frames,
        "joints_before": args.joints // JOINTS * JOINTS,
        "gestures": len({gesture.operation_id for gesture in ledger.acknowledged}),
        "median_ms": _percentile(times, 0.5),
        "p95_ms": _percentile(times, 0.95),
        "p99_ms": _percentile(times, 0.99),
        "max_ms": _percentile(times, 1.0),
        "listeners": args.listeners,
        "studio_cpu_ms": round(1e3 * (after - before) / len(times), 2)
        if times and before and after and studio.starts == 1
        else None,
        "conflicts": ledger.conflicts,
        "sent_twice": ledger.doubled,
        "sent_again": ledger.resent,
        "restarts": studio.starts - 1,
        "faults": faults,
    }


async def _annotate(studio: ServedStudio, sequence: str, args: argparse.Namespace) -> Any:
    work = asyncio.create_task(
        annotate_together(studio.url, annotations_of(sequence), args.frames, args.annotators, args.seconds, args.pause)
    )
    listening = [asyncio.create_task(_listen(studio.url, sequence)) for _ in range(args.listeners)]
    until = time.monotonic() + args.seconds
    while args.kill_every and time.monotonic() + args.kill_every < until and not work.done():
        await asyncio.sleep(args.kill_every)
        await asyncio.to_thread(studio.kill_and_restart)
    ledger = await work
    for listener in listening:
        listener.cancel()
    return ledger


async def _listen(url: str, sequence: str) -> None:
    """As an open page does: hear of every change, and connect again when the studio has gone."""
    async with httpx.AsyncClient(base_url=f"{url}/api/v1", timeout=None) as client:
        while True:
            with contextlib.suppress(httpx.HTTPError):
                async with client.stream("GET", f"/sequences/{sequence}/live") as answer:
                    async for _ in answer.aiter_raw():
                        pass
            await asyncio.sleep(1.0)


def annotations_of(sequence_id: str) -> str:
    """Where the annotations of the benchmark's recording are, up to the frame."""
    return f"/sequences/{sequence_id}/annotations/{CAMERA}"


def _percentile(times: list[float], part: float) -> float | None:
    return round(times[min(len(times) - 1, int(part * len(times)))], 2) if times else None


def show(result: dict[str, Any]) -> str:
    """For people."""
    lines = [
        f"{result['annotators']} annotators for {result['seconds']:g} s on {result['database']}: "
        f"{result['gestures']} gestures saved",
        f"  a save takes {result['median_ms']} ms (median), {result['p95_ms']} (95 %), {result['p99_ms']} (99 %), "
        f"{result['max_ms']} (worst)",
        f"  the studio's processor works {result['studio_cpu_ms']} ms for each, {result['listeners']} pages listening",
        f"  {result['conflicts']} met somebody else's, {result['sent_twice']} sent twice at once, "
        f"{result['sent_again']} sent again, {result['restarts']} times killed",
        f"  lost or double: {len(result['faults'])}",
        *(f"    {fault}" for fault in result["faults"][:20]),
    ]
    return "\n".join(lines)


def write_recording(folder: Path, frames: int, joints: int) -> Path:
    """A recording of tiny pictures that carry their number, with the hands annotated in its first frames."""
    import cv2
    import numpy as np

    (folder / "color").mkdir(parents=True)
    for frame in range(frames):
        image = np.full((HEIGHT, WIDTH, 3), 96, np.uint8)
        for bit in range(BITS):
            image[: 2 * STRIPE, bit * STRIPE : (bit + 1) * STRIPE] = 255 * (frame >> bit & 1)
        cv2.imwrite(str(folder / "color" / f"{frame:06d}.png"), image)
    camera = {
        "id": CAMERA,
        "width": WIDTH,
        "height": HEIGHT,
        "K": [[60, 0, 32], [0, 60, 24], [0, 0, 1]],
        "distortion": [],
        "T_world_camera": np.eye(4).tolist(),
        "color": "color/{:06d}.png",
    }
    description = {
        "version": 1,
        "name": "Load",
        "fps": 30.0,
        "frame_count": frames,
        "cameras": [camera],
        "hands": ["right", "left"],
        "objects": [],
        "annotations": "annotations.json",
    }
    points = [[float(10 + n), float(8 + n), 2] for n in range(JOINTS)]
    items = [
        {"frame": frame, "camera": CAMERA, "hand": hand, "points": points}
        for frame, hand in ((n // 2, ("right", "left")[n % 2]) for n in range(min(joints // JOINTS, 2 * frames)))
    ]
    from tracker import HAND_JOINTS

    (folder / "sequence.json").write_text(json.dumps(description))
    (folder / "annotations.json").write_text(json.dumps({"version": 1, "joints": list(HAND_JOINTS), "items": items}))
    return folder


class ServedStudio:
    """`handloom serve` in a process of its own, on a port that it keeps."""

    def __init__(self, data_dir: Path, database: str | None, *, with_worker: bool) -> None:
        self._environment = os.environ | {"HANDLOOM_DATA_DIR": str(data_dir)}
        if database:
            self._environment["HANDLOOM_DATABASE_URL"] = database
        self._with_worker = with_worker
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.url = f"http://127.0.0.1:{self.port}"
        self.starts = 0
        self._process: subprocess.Popen[bytes] | None = None

    def command(self, *arguments: str) -> dict[str, Any]:
        """What a command of Handloom prints with `--json`."""
        done = subprocess.run(
            [sys.executable, "-m", "server.cli", *arguments], env=self._environment, capture_output=True, text=True
        )
        if done.returncode:
            raise CommandError(f"handloom {' '.join(arguments)} failed: {done.stderr.strip()}", FAILED)
        return json.loads(done.stdout)

    def start(self) -> None:
        """Start it and wait until it answers."""
        command = [sys.executable, "-m", "server.cli", "serve", "--port", str(self.port)]
        if not self._with_worker:
            command.append("--no-worker")
        self._process = subprocess.Popen(
            command, env=self._environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )
        self.starts += 1
        deadline = time.monotonic() + START_SECONDS
        while time.monotonic() < deadline and self._process.poll() is None:
            with contextlib.suppress(httpx.HTTPError):
                if httpx.get(f"{self.url}/api/v1/health", timeout=5).is_success:
                    return
            time.sleep(0.1)
        raise CommandError("The studio did not start.", FAILED)

    def read_processor_seconds(self) -> float | None:
        """How long its process has worked so far, for reads and streams too; None where the system is not Linux."""
        assert self._process is not None
        try:
            fields = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        except OSError:
            return None
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def kill_and_restart(self) -> None:
        """`kill -9`, and start again."""
        assert self._process is not None
        self._process.kill()
        self._process.wait()
        self.start()

    def __enter__(self) -> ServedStudio:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        assert self._process is not None
        self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


@contextlib.contextmanager
def _tracking(studio: ServedStudio, folder: Path) -> Iterator[None]:
    """A worker busy with a recording, from its first tracked frame on, until the block ends."""
    studio.command("synthesize", "--motion", "open-close", "--frames", "0:1500", "--out", str(folder), "--json")
    client = httpx.Client(base_url=f"{studio.url}/api/v1", timeout=60)
    sequence = studio.command("import", str(folder), "--json")["id"]
    job = client.post("/jobs", json={"kind": "track", "sequence_id": sequence, "params": {}})
    job.raise_for_status()
    address = f"/jobs/{job.json()['id']}"
    while client.get(address).json()["frames_done"] == 0:
        if client.get(address).json()["state"] == "failed":
            raise CommandError("The tracking job failed.", FAILED)
        time.sleep(0.2)
    yield
    if (state := client.get(address).json())["state"] != "running":
        raise CommandError(f"The tracking job was {state['state']} before the annotators had done.", FAILED)
    client.post(f"{address}/cancel")
