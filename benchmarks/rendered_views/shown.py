"""A rendered recording of two hands, kept in a folder, with the poses that were drawn."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.sequence import Sequence, load_sequence
from tracker.capture.truth import Truth, load_truth
from tracker.model.ball import make_ball
from tracker.model.default_hand import default_hand
from tracker.model.npz_files import save_npz_model
from tracker.model.scene import Scene
from tracker.synthesis.ball import RADIUS
from tracker.synthesis.interplay import INTERPLAYS, find_poses, play
from tracker.synthesis.recording import RecordingOptions, write_recording
from tracker.synthesis.texture import Texture

Array = npt.NDArray[np.float64]

WHOLE, MOMENTS, STEP = 144, 32, 2
"""Of the whole of an interplay at 50 moments a second, every second of so many about its middle is shown."""

SIZE = (1280, 720)
"""The recordings of [T16] §4.4 have 1920x1080; what disturbs them covers more of these."""


@dataclass(frozen=True)
class Shown:
    """What is tracked and what is true.

    Attributes:
        name: Of `INTERPLAYS`.
        sequence: Eight colour cameras.
        truth: Joints of both hands, 3D and in every view, and which a view shows.
        scene: The very models that were drawn: right hand, left hand and the ball if there is one.
        poses: (T, D) drawn.
    """

    name: str
    sequence: Sequence
    truth: Truth
    scene: Scene
    poses: Array

    @property
    def names(self) -> tuple[str, ...]:
        return ("right", "left", "ball")[: len(self.scene.models)]


def show(name: str, work: Path, moments: int = MOMENTS, size: tuple[int, int] = SIZE) -> Shown:
    """Render once, then read."""
    models = {side: default_hand(side) for side in ("right", "left")}
    balls = (make_ball(RADIUS),) if INTERPLAYS[name][1] else ()
    scene = Scene((*models.values(), *balls))
    first = (WHOLE - STEP * moments) // 2
    middle = range(first, first + STEP * moments, STEP)
    folder = work / f"{name}_{moments}_{size[0]}x{size[1]}"
    if not folder.exists():
        options = RecordingOptions(middle, sensor=None, texture=Texture())
        write_recording(play(models, name, WHOLE, 8, size), folder, options, save_npz_model)
    kept = folder / "poses.npy"
    if not kept.exists():
        np.save(kept, find_poses(scene, name, WHOLE)[middle.start : middle.stop : middle.step])
    return Shown(name, load_sequence(folder), load_truth(folder / "truth.npz"), scene, np.load(kept))
