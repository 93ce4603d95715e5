"""All or nothing, whatever happens in the middle."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tracker.capture import clean_leftovers, load_sequence, run_import

ROOT = Path(__file__).parents[3]
DIE = """
import os, signal, sys
from tracker.capture import run_import
def progress(what, share):
    if share > 0.5:
        os.kill(os.getpid(), signal.SIGKILL)
run_import(sys.argv[1], sys.argv[2], progress=progress)
"""
WAIT = """
import sys
from tracker.capture import run_import
said = False
def progress(what, share):
    global said
    if share > 0.5 and not said:
        said = True
        print("half", flush=True)
        sys.stdin.readline()
run_import(sys.argv[1], sys.argv[2], progress=progress)
"""


def start(script: str, *arguments: Path) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", script, *map(str, arguments)],
        cwd=ROOT,
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def test_a_killed_import_leaves_no_recording_and_its_rest_is_cleaned(recording: Path, tmp_path: Path) -> None:
    store = tmp_path / "store"
    process = start(DIE, recording, store / "r")
    process.communicate()
    assert process.returncode == -signal.SIGKILL
    left = [p.name for p in store.iterdir()]
    assert len(left) == 1 and left[0].startswith(".r.unfinished-")
    (store / "other").mkdir()
    (store / ".mine.unfinished-not").mkdir()
    run_import(recording, store / "r")
    assert sorted(p.name for p in store.iterdir()) == [".mine.unfinished-not", "other", "r"]
    assert load_sequence(store / "r").frame_count == 5


def test_an_import_that_still_runs_is_left_alone(recording: Path, tmp_path: Path) -> None:
    store = tmp_path / "store"
    process = start(WAIT, recording, store / "slow")
    assert process.stdout is not None and process.stdout.readline() == "half\n"
    assert clean_leftovers(store) == []
    run_import(recording, store / "fast")
    process.communicate("go\n")
    assert process.returncode == 0
    assert sorted(p.name for p in store.iterdir()) == ["fast", "slow"]


def test_an_import_that_its_caller_stops_leaves_nothing(recording: Path, tmp_path: Path) -> None:
    def stop(what: str, share: float) -> None:
        if share > 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_import(recording, tmp_path / "store/r", progress=stop)
    assert os.listdir(tmp_path / "store") == []


def test_leftovers_of_a_folder_that_is_not_there_are_none(tmp_path: Path) -> None:
    assert clean_leftovers(tmp_path / "nothing") == []
