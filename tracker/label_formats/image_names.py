"""Which frame of which camera an image file name means, and back."""

from __future__ import annotations

import json
from collections import defaultdict
from dataclasses import dataclass, field
from pathlib import PurePosixPath
from typing import Any

from tracker.capture.document import read_regular_file
from tracker.capture.import_run import SOURCES_FILE
from tracker.capture.sequence import Sequence
from tracker.errors import SequenceError, TrackerError

MAX_SOURCES_BYTES = 512 * 1024 * 1024
"""Of sources.json; a bound of ours."""
Place = tuple[str, int]
"""Camera and frame."""


@dataclass(frozen=True)
class ImageNames:
    """Names of a recording's images.

    Attributes:
        originals: For each place the file that it came from, where that is a file of its own and no part of a video.
        stored: For each place its file in the recording.
    """

    originals: dict[Place, str]
    stored: dict[Place, str]
    _ends: list[dict[str, set[Place]]] = field(default_factory=list)

    def name(self, place: Place) -> str:
        """What to call the image of a place in a file for others: as it was called originally, where that is known."""
        return self.originals.get(place) or self.stored[place]

    def find(self, name: str, camera: str | None = None) -> list[Place]:
        """Places that a name may mean. The longest end of it that is known decides, original names before stored ones;
        then the camera, told or in its path."""
        if not self._ends:
            self._ends.extend(_index_ends(names) for names in (self.originals, self.stored))
        parts = PurePosixPath(name.replace("\\", "/")).parts
        for start in range(len(parts)):
            for ends in self._ends:
                if found := ends.get("/".join(parts[start:]).casefold()):
                    hinted = [place for place in found if place[0] == camera or place[0] in parts[:-1]]
                    return sorted(hinted if len(found) > 1 and hinted else found)
        return []


def _index_ends(names: dict[Place, str]) -> dict[str, set[Place]]:
    """Places by each end of their name: `b/c.png` and `c.png` of `a/b/c.png`."""
    found: dict[str, set[Place]] = defaultdict(set)
    for place, name in names.items():
        parts = PurePosixPath(name).parts
        for start in range(len(parts)):
            found["/".join(parts[start:]).casefold()].add(place)
    return found


def list_image_names(sequence: Sequence) -> ImageNames:
    """Names of a recording's images, from its patterns and from what its import noted."""
    stored: dict[Place, str] = {}
    for camera in sequence.cameras:
        pattern = camera.color or camera.depth
        if pattern is None:
            continue  # a film has no images with names
        for frame in range(sequence.frame_count):
            stored[camera.id, frame] = pattern.path(frame)
    return ImageNames(_read_originals(sequence), stored)


def _read_originals(sequence: Sequence) -> dict[Place, str]:
    path = sequence.folder / SOURCES_FILE
    if not path.is_file():
        return {}
    try:
        document: Any = json.loads(read_regular_file(path, MAX_SOURCES_BYTES, SequenceError))
    except (TrackerError, ValueError, RecursionError):
        return {}  # written by the import and for people; a recording without it is as usable
    found: dict[Place, str] = {}
    cameras = document.get("cameras", {}) if isinstance(document, dict) else {}
    for camera in sequence.cameras:
        kinds = cameras.get(camera.id, {}) if isinstance(cameras, dict) else {}
        entries = kinds.get("color" if camera.has_color else "depth", []) if isinstance(kinds, dict) else []
        for frame, entry in enumerate(entries[: sequence.frame_count] if isinstance(entries, list) else []):
            source = entry.get("source") if isinstance(entry, dict) else None
            if isinstance(source, str) and source and "#" not in source:
                found[camera.id, frame] = source
    return found
