"""A worker's name belongs to one living process."""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

from server.jobs.worker_name import WorkerName

HOLD = "import sys, time; from pathlib import Path; from server.jobs.worker_name import WorkerName; \
slot = WorkerName.acquire(Path(sys.argv[1]), 'desk'); print(slot.name, flush=True); time.sleep(60)"


def test_a_name_is_free_again_the_moment_its_process_is_killed(tmp_path: Path) -> None:
    holder = subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path)], stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    name = holder.stdout.readline().strip()
    other = WorkerName.acquire(tmp_path, "desk")
    assert other.name != name
    holder.send_signal(signal.SIGKILL)
    holder.wait()
    assert WorkerName.acquire(tmp_path, "desk").name == name
