"""What is wrong with what cameras filmed, all of it at once, before the board is looked for in every frame."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tracker.calibration.camera_faults import FilmLength, find_length_faults
from tracker.calibration.camera_source import USUAL_FPS, CameraSource, find_count_fault, open_source
from tracker.calibration.lens import Lens
from tracker.errors import CalibrationError, FrameError


@dataclass(frozen=True)
class SourceCheck:
    """What was found.

    Attributes:
        sources: Those that can be opened.
        sizes: Of their first frames, width and height, px.
        faults: Sentences; empty when all is well as far as headers and first frames tell.
    """

    sources: tuple[CameraSource, ...]
    sizes: tuple[tuple[int, int], ...]
    faults: tuple[str, ...]


def check_sources(
    cameras: Mapping[str, Path],
    fps: float | None = None,
    find_offsets: bool = True,
    lenses: Mapping[str, Lens] | None = None,
) -> SourceCheck:
    """Open every camera's pictures and look at the first one.

    Args:
        cameras: Names and videos or folders of images.
        fps: Frames a second of folders of images.
        find_offsets: Videos may be out of step.
        lenses: Known lenses by the cameras' names; None when none are given.
    """
    count_fault = find_count_fault(list(cameras))
    faults = [count_fault] if count_fault else []
    sources, sizes = [], []
    for name, path in cameras.items():
        try:
            source = open_source(name, path, fps)
            first = next(source.read(), None)
        except (CalibrationError, FrameError) as fault:
            faults.append(str(fault) if str(fault).startswith(name) else f"{name}: {fault}")
            continue
        if first is None:
            faults.append(f"{name}: no frame can be decoded; is it cut off, or in a codec that is not known here?")
            continue
        sources.append(source)
        sizes.append((first[1].shape[1], first[1].shape[0]))
    lengths = [FilmLength(source.id, source.promised, source.fps or USUAL_FPS) for source in sources if source.promised]
    faults += find_length_faults(lengths, find_offsets)
    if lenses is not None:
        known = ", ".join(lenses)
        faults += [
            f"{name}: no lens of this name was given (there are {known})." for name in cameras if name not in lenses
        ]
    return SourceCheck(tuple(sources), tuple(sizes), tuple(faults))
