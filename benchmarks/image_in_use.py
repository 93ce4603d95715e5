"""The image of docker/ as a team uses it: PostgreSQL, S3, web and two workers, a job killed on one, ended on the other.

    docker/build_image.sh --stand-ins handloom:local
    BUILDAH_ISOLATION=chroot STORAGE_DRIVER=vfs python -m benchmarks.image_in_use [--image handloom:local]

Runs as root. Containers share this machine's network; PostgreSQL and the S3 server (moto's) run beside them.
"""

from __future__ import annotations

import argparse
import json
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import Any

import boto3
import httpx
import psutil
import psycopg
from moto.server import ThreadedMotoServer

from tests.postgres import run_postgres

PASSWORD = "four words in a row"
FRAMES = 150
KEYS = {"AWS_ACCESS_KEY_ID": "handloom", "AWS_SECRET_ACCESS_KEY": "handloom", "AWS_DEFAULT_REGION": "us-east-1"}
WORKERS = ("worker-1", "worker-2")
WAIT_SECONDS = 600.0


class Container:
    """A container of the image, in which commands run as its user."""

    def __init__(self, image: str, environment: dict[str, str]) -> None:
        self.name = _buildah("from", "--pull-never", image).strip()
        self._options = [part for name, value in environment.items() for part in ("--env", f"{name}={value}")]

    def start(self, *command: str) -> psutil.Popen:
        return psutil.Popen(["buildah", "run", "--user", "handloom", *self._options, self.name, "--", *command])

    def run(self, *command: str, stdin: str = "") -> str:
        done = subprocess.run(
            ["buildah", "run", "--user", "handloom", *self._options, self.name, "--", *command],
            input=stdin,
            capture_output=True,
            text=True,
            check=False,
        )
        if done.returncode != 0:
            raise SystemExit(f"{' '.join(command)}: {done.stderr[-1000:]}")
        return done.stdout

    def remove(self) -> None:
        _buildah("rm", self.name)


def _buildah(*arguments: str) -> str:
    return subprocess.run(["buildah", *arguments], check=True, capture_output=True, text=True).stdout


@contextmanager
def run_stores() -> Iterator[dict[str, str]]:
    """PostgreSQL with an empty database and an S3 server with an empty bucket; gives the settings that name them."""
    server = ThreadedMotoServer(ip_address="127.0.0.1", port=0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    endpoint = f"http://{host}:{port}"
    boto3.client(
        "s3",
        endpoint_url=endpoint,
        aws_access_key_id="handloom",
        aws_secret_access_key="handloom",
        region_name="us-east-1",
    ).create_bucket(Bucket="handloom")
    try:
        with run_postgres(is_durable=True) as address:
            with psycopg.connect(f"{address}/postgres", autocommit=True) as connection:
                connection.execute("CREATE DATABASE handloom")
            yield {
                "HANDLOOM_DATABASE_URL": f"{address}/handloom",
                "HANDLOOM_STORE_URL": "s3://handloom/studio",
                "HANDLOOM_STORE_ENDPOINT": endpoint,
                **KEYS,
            }
    finally:
        server.stop()


class Studio:
    """The web container, as a logged-in admin sees it."""

    def __init__(self, port: int) -> None:
        address = f"http://127.0.0.1:{port}"
        self.client = httpx.Client(base_url=address, headers={"Origin": address}, timeout=60.0)

    def log_in(self) -> None:
        _wait("the studio", self._answers)
        self.client.post("/api/v1/login", json={"name": "ada", "password": PASSWORD}).raise_for_status()

    def _answers(self) -> bool:
        try:
            return self.client.get("/api/v1/health").is_success
        except httpx.TransportError:
            return False

    def get(self, path: str) -> dict[str, Any]:
        return self.client.get(f"/api/v1{path}").raise_for_status().json()

    def track(self, recording: str) -> str:
        body = {"kind": "track", "sequence_id": recording, "params": {"calibrate": False}}
        return self.client.post("/api/v1/jobs", json=body).raise_for_status().json()["id"]

    def has_done(self, job: str, frames: int) -> bool:
        found = self.get(f"/jobs/{job}")
        if found["state"] in ("failed", "cancelled"):
            raise SystemExit(f"the job {found['state']}: {found['error']}")
        return found["state"] == "succeeded" or found["frames_done"] >= frames


def _wait(what: str, is_reached: Any) -> float:
    began = time.monotonic()
    while not is_reached():
        if time.monotonic() - began > WAIT_SECONDS:
            raise SystemExit(f"{what} was not reached within {WAIT_SECONDS:g} s")
        time.sleep(0.2)
    return time.monotonic() - began


def kill(container: psutil.Popen) -> None:
    """Kill a worker as a machine that dies does, with all that it has started."""
    for process in [*container.children(recursive=True), container]:
        process.kill()
    container.wait()


def use(image: str) -> dict[str, Any]:
    """What the run showed."""
    with ExitStack() as stack:
        stores = stack.enter_context(run_stores())
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            port = probe.getsockname()[1]
        containers = {}
        for name in ("web", *WORKERS):
            containers[name] = Container(image, stores | {"HANDLOOM_LOGIN": "required", "HANDLOOM_WORKER_HOST": name})
            stack.callback(containers[name].remove)
        web = containers["web"]
        web.run("handloom", "account", "add", "ada", "--role", "admin", stdin=PASSWORD + "\n")
        web.run(
            "handloom", "synthesize", "--motion", "open-close", "--frames", f"0:{FRAMES}", "--out", "/tmp/recording"
        )
        web.run("handloom", "import", "/tmp/recording")
        began = time.monotonic()
        stack.callback(kill, web.start("handloom", "serve", "--no-worker", "--port", str(port)))
        studio = Studio(port)
        studio.log_in()
        started = time.monotonic() - began
        page = studio.client.get("/").raise_for_status()
        [recording] = studio.get("/sequences")["items"]
        job = studio.track(recording["id"])
        running = {name: containers[name].start("handloom", "worker") for name in WORKERS}
        _wait("the second chunk", lambda: studio.has_done(job, FRAMES // 3))
        killed = studio.get(f"/jobs/{job}")
        kill(running.pop(killed["worker"]["host"]))
        for process in running.values():
            stack.callback(kill, process)
        seconds = _wait("the end of the job", lambda: studio.has_done(job, FRAMES + 1))
        ended = studio.get(f"/jobs/{job}")
        lines = [line["text"] for line in studio.get(f"/jobs/{job}/log")["lines"]]
        track = studio.get(f"/tracks/{ended['track_id']}/frames")
        return {
            "first_page_seconds": round(started, 1),
            "page_bytes": len(page.content),
            "killed_on": killed["worker"]["host"],
            "killed_after_frames": killed["frames_done"],
            "ended_on": ended["worker"]["host"],
            "seconds_from_kill_to_end": round(seconds, 1),
            "frames_in_track": len(track["frame"]),
            "was_resumed": "its worker crashed; going on after the last finished step" in lines,
            "started_once": lines.count("placing the right hand") == 1,
        }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--image", default="handloom:local")
    found = use(parser.parse_args().image)
    print(json.dumps(found, indent=1))
    is_good = found["killed_on"] != found["ended_on"] and found["frames_in_track"] == FRAMES
    raise SystemExit(0 if is_good and found["was_resumed"] and found["started_once"] else 1)


if __name__ == "__main__":
    main()
