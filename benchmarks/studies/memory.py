"""Memory over many frames, in a process of its own.

`python -m benchmarks.studies.memory DATA TWINS FRAMES` prints it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from benchmarks.studies.trial import ROOT
from benchmarks.studies.twin_runs import render_twin, start_twin
from tracker.fitting.options import TrackOptions
from tracker.search.tools import make_tools
from tracker.tracking.follow import follow_frame

EVERY = 100
"""Frames between two looks at the memory."""


@dataclass(frozen=True)
class Memory:
    """Resident memory while sequence 12 is followed, over again when it ends, for so many frames."""

    tracked: int

    def __call__(self, data: Path, twins: Path) -> dict[str, Any]:
        """Run and sample in a fresh process."""
        command = [sys.executable, "-m", "benchmarks.studies.memory", str(data), str(twins), str(self.tracked)]
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
        return {"megabytes": json.loads(done.stdout.splitlines()[-1]), "every": EVERY}


def resident_megabytes() -> float:
    """Of this process."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def sample_memory(data: Path, twins: Path, tracked: int) -> list[float]:
    """MB after the first frame and after every EVERY frames."""
    twin = render_twin(data, twins, "12", None, 1, 0)
    setup, start = start_twin(twin, TrackOptions(terms="LO+SC", calibrate=False))
    camera, count = twin.sequence.camera(setup.camera_id), twin.sequence.frame_count
    state, found = start, []
    with make_tools(setup, camera.T_world_camera) as tools:
        for number in range(tracked):
            if state.next_frame >= count:
                state = replace(start)
            state, _ = follow_frame(twin.sequence, setup, tools, state, recover=True)
            if number % EVERY == 0 or number == tracked - 1:
                found.append(resident_megabytes())
    return found


if __name__ == "__main__":
    print(json.dumps(sample_memory(Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3]))))
