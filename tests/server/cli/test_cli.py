"""The command `handloom`, as people and scripts run it."""

from __future__ import annotations

import io
import json
import os
import resource
import shlex
import shutil
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path

import cv2
import httpx
import numpy as np
import pytest

from server.cli.main import main
from tests.server.conftest import GeneratedHand

ROOT = Path(__file__).resolve().parents[3]
API = "api/v1"


def environment(data: Path, **more: str) -> dict[str, str]:
    return {**os.environ, "HANDLOOM_DATA_DIR": str(data), "PYTHONPATH": str(ROOT), **more}


def handloom(data: Path, *arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "server.cli", *arguments]
    return subprocess.run(command, capture_output=True, text=True, env=environment(data, **more), timeout=240)


def run_here(data: Path, *arguments: str, given: str = "") -> subprocess.CompletedProcess[str]:
    """The same in this process, which has loaded all of it already; `given` comes through a pipe."""
    told, failed = io.StringIO(), io.StringIO()
    with pytest.MonkeyPatch.context() as patch, redirect_stdout(told), redirect_stderr(failed):
        patch.setenv("HANDLOOM_DATA_DIR", str(data))
        patch.setattr(sys, "stdin", io.StringIO(given))
        code = main(list(arguments))
    return subprocess.CompletedProcess(arguments, code, told.getvalue(), failed.getvalue())


@contextmanager
def serving(data: Path, *arguments: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """A studio in a process of its own and its address."""
    command = [sys.executable, "-m", "server.cli", *arguments]
    process = subprocess.Popen(
        command, stdout=subprocess.PIPE, text=True, env=environment(data), start_new_session=True
    )
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        assert line.startswith("Handloom is at http://127.0.0.1:"), line
        yield process, line.split()[3]
    finally:
        if process.poll() is None:
            process.terminate()
        process.wait(30)


def wait_for_worker(address: str, other_than: int | None = None) -> int:
    """Process id of the worker that runs."""
    ends = time.monotonic() + 60
    while time.monotonic() < ends:
        for worker in httpx.get(f"{address}/{API}/workers").json()["items"]:
            if worker["state"] == "running" and worker["pid"] != other_than:
                return worker["pid"]
        time.sleep(0.1)
    raise AssertionError("no worker")


def wait_for_job(address: str, job_id: str, states: tuple[str, ...] = ("succeeded",), frames: int = 0) -> dict:
    ends = time.monotonic() + 120
    while time.monotonic() < ends:
        job = httpx.get(f"{address}/{API}/jobs/{job_id}").json()
        if job["state"] in states and job["frames_done"] >= frames:
            return job
        assert job["state"] != "failed", job["error"]
        time.sleep(0.05)
    raise AssertionError(job)


def is_alive(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    return True


def wait_for_death(pid: int) -> None:
    ends = time.monotonic() + 15
    while is_alive(pid) and time.monotonic() < ends:
        time.sleep(0.05)
    assert not is_alive(pid)


def test_help_names_every_command_and_is_quick(tmp_path: Path) -> None:
    began = resource.getrusage(resource.RUSAGE_CHILDREN)
    shown = handloom(tmp_path, "--help")
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = ended.ru_utime + ended.ru_stime - began.ru_utime - began.ru_stime
    assert shown.returncode == 0
    for command in ("serve", "worker", "demo", "import", "export", "track", "evaluate", "synthesize", "warm-up"):
        assert command in shown.stdout
    loaded = handloom_modules(tmp_path)
    assert not loaded & {"numpy", "cv2", "numba", "fastapi", "sqlalchemy", "dbos", "pydantic"}, loaded
    assert seconds < 2.0, "of a processor: what others do on the machine is not its fault"


def handloom_modules(data: Path) -> set[str]:
    """What `import server.cli` loads."""
    code = "import sys, server.cli; print(' '.join(sys.modules))"
    shown = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=environment(data))
    return set(shown.stdout.split())


def test_a_host_that_others_can_reach_is_refused(tmp_path: Path) -> None:
    """As long as nobody could let anybody in."""
    for arguments, more in ((("--host", "0.0.0.0"), {}), ((), {"HANDLOOM_LOGIN": "required"})):
        refused = handloom(tmp_path, "serve", *arguments, "--port", "0", **more)
        assert refused.returncode == 2
        assert "no admin can yet" in refused.stderr and "handloom account add" in refused.stderr


def test_people_are_added_with_a_password_from_a_pipe(tmp_path: Path) -> None:
    def account(*arguments: str, password: str = "") -> subprocess.CompletedProcess[str]:
        return run_here(tmp_path, "account", *arguments, given=f"{password}\n")

    short = account("add", "Lea", "--role", "admin", password="short")
    assert (short.returncode, "needed 10 to 200" in short.stderr) == (2, True)
    assert account("add", "Lea", "--role", "admin", password="four words in a row").returncode == 0
    made = json.loads(account("add", "Mia", "--code", "--json").stdout)
    assert (made["name"], made["role"], len(made["code"]) > 40) == ("Mia", "annotator", True)
    assert account("disable", "Mia").returncode == 0
    people = json.loads(account("list", "--json").stdout)["accounts"]
    assert {(one["name"], one["state"]) for one in people} == {
        ("Lea", "may log in"),
        ("Mia", "disabled"),
        ("local", "has no password"),
    }
    from server.cli.serve import check_an_admin_can_log_in
    from server.settings import Settings

    check_an_admin_can_log_in(Settings(data_dir=tmp_path, host="0.0.0.0"))


def test_a_port_that_is_taken_is_named(tmp_path: Path) -> None:
    with socket.socket() as holder:
        holder.bind(("127.0.0.1", 0))
        holder.listen()
        port = holder.getsockname()[1]
        refused = handloom(tmp_path, "serve", "--port", str(port))
    assert refused.returncode == 1
    assert f"Port {port} is taken" in refused.stderr


def test_settings_that_make_no_sense_are_named(tmp_path: Path) -> None:
    refused = handloom(tmp_path, "serve", HANDLOOM_PORT="many")
    assert refused.returncode == 2
    assert "HANDLOOM_PORT" in refused.stderr
    assert "Traceback" not in refused.stderr


def test_import_and_export_carry_a_recording_in_and_out_again(tmp_path: Path, rendered: Path) -> None:
    data = tmp_path / "data"
    done = handloom(data, "import", str(rendered), "--name", "a wave", "--json")
    assert done.returncode == 0, done.stderr
    result = json.loads(done.stdout)
    assert (result["name"], result["frames"], result["report"]["ok"]) == ("a wave", 45, True)
    out = tmp_path / "annotations.json"
    assert run_here(data, "export", "a wave", "--format", "annotations", "--out", str(out)).returncode == 0
    assert len(json.loads(out.read_text())["items"]) == 45
    again = run_here(data, "export", "a wave", "--format", "annotations", "--out", str(out))
    assert again.returncode == 2
    assert "is there already" in again.stderr
    folder = tmp_path / "copy"
    assert run_here(data, "export", result["id"], "--format", "recording", "--out", str(folder)).returncode == 0
    back = run_here(tmp_path / "other", "import", str(folder), "--json")
    assert json.loads(back.stdout)["name"] == "a wave"
    missing = run_here(data, "export", "nobody", "--format", "recording", "--out", str(tmp_path / "x"))
    assert missing.returncode == 2
    assert "'a wave'" in missing.stderr
    untracked = run_here(data, "export", "a wave", "--format", "track", "--out", str(tmp_path / "x"))
    assert "has no track yet" in untracked.stderr


def test_what_is_no_recording_is_refused_and_nothing_stays(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "folder" / "notes.txt").write_text("nothing")
    refused = handloom(tmp_path / "data", "import", str(tmp_path / "folder"))
    assert refused.returncode == 2
    assert "Traceback" not in refused.stderr
    assert list((tmp_path / "data" / "sequences").glob("*")) == []
    assert run_here(tmp_path / "data", "import", str(tmp_path / "none")).returncode == 2


@pytest.mark.slow
def test_the_studio_does_jobs_and_outlives_its_worker_and_itself(tmp_path: Path, rendered: Path) -> None:
    data = tmp_path / "data"
    sequence_id = json.loads(handloom(data, "import", str(rendered), "--json").stdout)["id"]
    body = {"sequence_id": sequence_id, "params": {"calibrate": False}}
    with serving(data, "serve", "--port", "0") as (studio, address):
        worker = wait_for_worker(address)
        first = httpx.post(f"{address}/{API}/jobs", json=body).json()
        wait_for_job(address, first["id"], ("running",), frames=3)
        os.kill(worker, signal.SIGKILL)
        assert wait_for_job(address, first["id"])["track_id"] is not None
        worker = wait_for_worker(address, other_than=worker)
        second = httpx.post(f"{address}/{API}/jobs", json=body).json()
        wait_for_job(address, second["id"], ("running",), frames=3)
        studio.kill()  # the studio itself, in mid-job
        studio.wait(10)
    wait_for_death(worker)
    with serving(data, "serve", "--port", "0") as (studio, address):
        assert wait_for_job(address, second["id"])["frames_done"] == 45
        worker = wait_for_worker(address)
        studio.send_signal(signal.SIGINT)
        assert studio.wait(30) in (0, 130)
        wait_for_death(worker)
    out = tmp_path / "track"
    exported = handloom(data, "export", second["track_id"] or sequence_id, "--format", "track", "--out", str(out))
    assert exported.returncode == 0, exported.stderr
    assert (out / "track.npz").is_file()
    for kind, start in (("npz", b"PK"), ("csv", b"frame,status,joint,x,y,z,"), ("glb", b"glTF"), ("mano", b"PK")):
        file = tmp_path / f"track.{kind}"
        exported = handloom(data, "export", sequence_id, "--format", kind, "--out", str(file), "--json")
        assert exported.returncode == 0, exported.stderr
        assert json.loads(exported.stdout)["frames"] == 45
        assert file.read_bytes().startswith(start)
    assert not [entry for entry in tmp_path.iterdir() if entry.name.startswith(".")]


@pytest.mark.slow
def test_the_demo_makes_its_samples_once_and_tracks_one(tmp_path: Path) -> None:
    data = tmp_path / "data"
    for _ in range(2):
        with serving(data, "demo", "--port", "0") as (_studio, address):
            recordings = httpx.get(f"{address}/{API}/sequences").json()["items"]
            found = {recording["name"]: recording for recording in recordings}
            assert len(recordings) == len(found) == 2
            assert len(found["Sample: a pinch in three cameras"]["cameras"]) == 3
            assert found["Sample: open and close"]["annotated_frames"] == 4
            assert len(httpx.get(f"{address}/{API}/scans").json()["items"]) == 32
            jobs = {job["kind"]: job for job in httpx.get(f"{address}/{API}/jobs").json()["items"]}
            assert sorted(jobs) == ["register", "track"]
            job = wait_for_job(address, jobs["track"]["id"])
            result = httpx.get(f"{address}/{API}/tracks/{job['track_id']}/evaluation", timeout=60).json()
            assert result["evaluated"] == 4
            assert result["joint_error_px"]["mean"] < 4.0


def test_the_help_of_import_names_the_formats_there_are() -> None:
    from tracker.capture import IMPORT_FORMATS

    command = [sys.executable, "-m", "server.cli", "import", "--help"]
    shown = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert [name for name in IMPORT_FORMATS if name not in shown] == []


@pytest.mark.slow
def test_a_folder_of_scans_is_imported_once_and_what_is_none_is_named(
    tmp_path: Path, generated_hand: GeneratedHand
) -> None:
    folder = tmp_path / "Lab scans"
    folder.mkdir()
    shutil.copyfile(generated_hand.folder / "hand.ply", folder / "one.ply")
    (folder / "broken.stl").write_bytes(b"solid nothing")
    (folder / "scans.json").write_text(json.dumps([{"file": "one.ply", "subject": "Ada", "side": "right"}]))
    first = handloom(tmp_path / "data", "import", str(folder), "--json")
    assert first.returncode == 0, first.stderr
    made = json.loads(first.stdout)
    assert (made["collection"], [item["name"] for item in made["added"]]) == ("Lab scans", ["one"])
    assert [item["file"] for item in made["refused"]] == ["broken.stl"] and "broken.stl" in first.stderr
    again = json.loads(handloom(tmp_path / "data", "import", str(folder), "--json").stdout)
    assert (again["added"], [item["id"] for item in again["known"]]) == ([], [made["added"][0]["id"]])
    assert handloom(tmp_path / "data", "import", str(folder / "broken.stl")).returncode == 2


def test_a_refused_recording_lists_every_option_that_is_needed_with_a_command_that_has_them(tmp_path: Path) -> None:
    folder = tmp_path / "my take"
    for kind, far in (("depth", 700), ("infrared", 800)):
        (folder / kind).mkdir(parents=True)
        for number in range(3):
            image = np.full((424, 512), far + number, np.uint16)
            (folder / kind / f"{number:03d}.png").write_bytes(cv2.imencode(".png", image)[1].tobytes())
    refused = run_here(tmp_path / "data", "import", str(folder))
    assert (refused.returncode, refused.stdout) == (2, "")
    for option in ("--depth-pattern", "--fx", "--cx", "--cy", "--depth-scale", "kinect_v2"):
        assert option in refused.stderr
    assert "--fy" not in refused.stderr.split("Needed:")[1]
    example = shlex.split(refused.stderr.split("For example: handloom ")[1].splitlines()[0])
    done = run_here(tmp_path / "data", *example, "--json")
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["frames"] == 3 and any("typical values of Kinect v2" in text for text in found["report"]["warnings"])
