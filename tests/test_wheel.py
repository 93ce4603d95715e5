"""The wheel in an empty environment: `pip install handloom*.whl && handloom demo`, with the versions of the lock."""

from __future__ import annotations

import os
import re
import resource
import socket
import subprocess
import sys
import time
import venv
import zipfile
from pathlib import Path

import httpx
import pytest

ROOT = Path(__file__).resolve().parents[1]
FIRST_PAGE_SECONDS = 240.0
"""Bar of the first page, kernels not compiled, s of the processor: other work on the machine does not count."""

pytestmark = [pytest.mark.slow, pytest.mark.timeout(900)]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    run("pip", "wheel", "--quiet", "--no-deps", "--wheel-dir", str(folder), str(ROOT), python=sys.executable)
    [path] = folder.glob("handloom-*.whl")
    return path


def run(module: str, *arguments: str, python: str | Path) -> None:
    done = subprocess.run([python, "-m", module, *arguments], capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr[-2000:]


def test_the_wheel_holds_what_the_studio_needs_and_nothing_outside_its_two_packages(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        held = set(archive.namelist())
    folders = {name.split("/")[0] for name in held}
    assert {name for name in folders if not name.endswith(".dist-info")} == {"tracker", "server"}
    for here, there in (
        ("tracker", "tracker"),
        ("server", "server"),
        ("migrations", "server/migrations"),
        ("web/dist", "server/app/static"),
    ):
        files = [path for path in (ROOT / here).rglob("*") if path.is_file() and path.suffix != ".pyc"]
        assert files
        assert {f"{there}/{path.relative_to(ROOT / here)}" for path in files} <= held


def test_the_demo_serves_its_first_page_from_an_empty_environment(wheel: Path, tmp_path: Path) -> None:
    environment = tmp_path / "environment"
    venv.create(environment, with_pip=True)
    versions = re.findall(r"^[a-z0-9-]+==.*?(?= \\$)", (ROOT / "requirements.lock").read_text(), re.MULTILINE)
    (tmp_path / "versions.txt").write_text("\n".join(versions))
    python = environment / "bin" / "python"
    run("pip", "install", "--quiet", str(wheel), "--constraint", str(tmp_path / "versions.txt"), python=python)

    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    (tmp_path / "elsewhere").mkdir()
    variables = {name: value for name, value in os.environ.items() if not name.startswith(("HANDLOOM", "PYTHON"))}
    variables |= {"HANDLOOM_DATA_DIR": str(tmp_path / "data"), "NUMBA_CACHE_DIR": str(tmp_path / "kernels")}
    before = measure_children()
    with (tmp_path / "log").open("w") as log:
        demo = subprocess.Popen(
            [environment / "bin" / "handloom", "demo", "--port", str(port), "--no-worker"],
            cwd=tmp_path / "elsewhere",
            env=variables,
            stdout=log,
            stderr=subprocess.STDOUT,
        )
    try:
        with httpx.Client(base_url=f"http://127.0.0.1:{port}", timeout=30.0) as client:
            page = wait_for_page(client, demo, tmp_path / "log")
            script = re.findall(r'<script type="module" crossorigin src="([^"]+)"', page)
            assert len(script) == 1
            assert client.get(script[0]).headers["content-type"].startswith("text/javascript")
            recordings = client.get("/api/v1/sequences").json()["items"]
            assert {one["name"] for one in recordings} == {
                "Sample: open and close",
                "Sample: a pinch in three cameras",
            }
    finally:
        demo.terminate()
        assert demo.wait(60) == 0, (tmp_path / "log").read_text()[-2000:]
    assert measure_children() - before < FIRST_PAGE_SECONDS


def measure_children() -> float:
    """s of the processor that processes which have ended took."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def wait_for_page(client: httpx.Client, demo: subprocess.Popen[bytes], log: Path) -> str:
    """The first page, as soon as the studio answers."""
    while demo.poll() is None:
        try:
            answer = client.get("/")
        except httpx.TransportError:
            time.sleep(0.5)
            continue
        assert answer.status_code == 200
        return answer.text
    raise AssertionError(log.read_text()[-2000:])
