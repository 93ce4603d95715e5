"""What people read when a job has failed: sentences, without tracebacks and without paths of the machine."""

from __future__ import annotations

import re
from pathlib import Path

from server.errors import StudioError

PATH = re.compile(r"(?<![\w./])(?:[A-Za-z]:)?/(?:[^\s/'\",;]+/)+")
"""The folders of an absolute path: what stands before its last part."""

RECORDING = re.compile(r"\bsequences/[0-9a-f]{8}(?:-[0-9a-f]{4}){3}-[0-9a-f]{12}/")
"""Where the studio keeps a recording: nobody knows it by that id, and the job says which one it is."""


def describe_error(error: Exception, number: str, root: Path) -> str:
    """What went wrong, for people.

    Args:
        error: What was raised. Of one that nobody foresaw nothing is told but that it happened.
        number: By which it is found in the log of the worker.
        root: The data folder.
    """
    from tracker import TrackerError

    if isinstance(error, (StudioError, TrackerError)):
        return hide_paths(str(error), root)
    return (
        f"An unexpected error occurred (error {number}). What was stored before is untouched. Try again. "
        f"If it happens again, tell whoever looks after the studio: the worker's log has the details under {number}."
    )


def hide_paths(text: str, root: Path) -> str:
    """A text without the folders that files lie in: of files of the studio the part below its data folder stays, of
    those of a recording the part within the recording."""
    below = text.replace(f"{root.resolve()}/", "").replace(f"{root}/", "")
    return PATH.sub("", RECORDING.sub("", below))
