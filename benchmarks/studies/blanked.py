"""A twin whose hands are out of sight for some frames."""

from __future__ import annotations

import os
import shutil
import tempfile
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np

from benchmarks.studies.twin_runs import Twin
from tracker.capture.sequence import load_sequence
from tracker.synthesis.performance import render_moment

EDGE = 4
"""px around what was rendered that are blanked too: the sensor's noise moves silhouettes."""


def blank_twin(twin: Twin, frames: range, actors: tuple[str, ...]) -> Twin:
    """The twin without the pixels of some actors in some frames: depth 0, colour black. Written once, beside it."""
    source = twin.sequence.folder
    folder = source.with_name(f"{source.name}_without_{'_'.join(actors)}_{frames.start}_{frames.stop}")
    if not folder.exists():
        unfinished = Path(tempfile.mkdtemp(prefix=f".{folder.name}.", dir=folder.parent))
        shutil.copytree(source, unfinished, dirs_exist_ok=True, copy_function=os.link)
        sequence = load_sequence(unfinished)
        camera = twin.performance.camera.id
        for frame in frames:
            gone = _find_pixels(twin, frame, actors)
            for kind in ("color", "depth"):
                path = sequence.image_path(kind, frame, camera)
                image = cv2.imread(str(path), cv2.IMREAD_UNCHANGED)
                assert image is not None, path
                image[gone] = 0
                path.unlink()  # a hard link: writing through it would change the twin
                cv2.imwrite(str(path), image)
        unfinished.rename(folder)
    return replace(twin, sequence=load_sequence(folder))


def _find_pixels(twin: Twin, frame: int, actors: tuple[str, ...]) -> np.ndarray:
    """(H, W) whether a pixel shows one of the actors."""
    moment = render_moment(twin.performance, int(twin.truth.source_frame[frame]))
    wanted = [index for index, actor in enumerate(twin.performance.actors) if actor.name in actors]
    shown = (moment.face >= 0) & np.isin(twin.performance.face_actors[moment.face], wanted)
    others = (moment.face >= 0) & ~shown
    near = cv2.dilate(shown.astype(np.uint8), np.ones((2 * EDGE + 1, 2 * EDGE + 1), np.uint8)) > 0
    return near & ~others
