"""What the tracker offers to other programs."""

from __future__ import annotations

import subprocess
import sys

import tracker


def test_every_name_that_is_offered_can_be_loaded() -> None:
    assert {name for name in tracker.__all__ if getattr(tracker, name, None) is None} == set()
    assert sorted(tracker.__all__) == sorted(tracker._HOMES)


def test_importing_the_tracker_loads_none_of_its_rooms() -> None:
    code = "import sys, tracker; print([name for name in sys.modules if name.startswith('tracker.')])"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "['tracker.kernel_cache']"
