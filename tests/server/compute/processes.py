"""Processes, as the system sees them."""

from __future__ import annotations

import os
import signal
import subprocess
import time


def wait_until(holds, seconds=20.0):
    deadline = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.02)


def find_children(parent):
    """Ids of the processes of this parent that are alive, and their commands."""
    table = subprocess.run(
        ["ps", "-ww", "-eo", "pid=,ppid=,stat=,args="], capture_output=True, text=True, check=True
    ).stdout
    rows = [line.split(None, 3) for line in table.splitlines()]
    return {int(pid): command for pid, ppid, state, command in rows if int(ppid) == parent and state[0] != "Z"}


def is_alive(pid):
    state = subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True).stdout
    return bool(state) and state[0] != "Z"


def stop(pid):
    """Make a process stand still; back when it does."""
    os.kill(pid, signal.SIGSTOP)
    os.waitid(os.P_PID, pid, os.WSTOPPED)
