"""Twins: the motions that T16's authors found in their recordings, on their models, rendered again.

Their recordings have no exact truth and these have; the motion is the same, real one.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from tracker.capture.camera import Camera
from tracker.errors import SequenceError, reading
from tracker.geometry import se3
from tracker.model.t16_files import load_t16_model, load_t16_motion
from tracker.synthesis.actor import Actor
from tracker.synthesis.performance import Performance
from tracker.synthesis.shading import OBJECT_COLORS, SKIN

IMAGE_SIZE = (640, 480)
"""Width and height, px, of the Carmine 1.09 [T16] §4.1; `Cameras.txt` does not name it."""

FPS = 30.0
"""Of the same camera."""


def load_twin(folder: Path, sequence: str, max_faces: int | None) -> Performance:
    """The performance behind one of T16's sequences.

    Args:
        folder: Holds `Cameras.txt`, `models/` and `seq/`.
        sequence: Folder in `seq/`, such as "09".
        max_faces: Reduce each mesh to so many faces; None renders the authors' full meshes.

    Raises:
        SequenceError: Something is missing or does not fit together.
        ModelFileError: A model or a motion cannot be read.
    """
    recorded = folder / "seq" / sequence
    info = recorded / "MODELS_INFO.txt"
    if not info.is_file():
        there = sorted(path.name for path in (folder / "seq").glob("*") if (path / "MODELS_INFO.txt").is_file())
        raise SequenceError(
            f"{folder}: has no sequence {sequence!r} ({info} is missing); "
            + (f"it has {', '.join(there)}." if there else "needed T16's folders `models` and `seq`.")
        )
    names = info.read_text(encoding="ascii", errors="replace").split()[1:]
    if not names:
        raise SequenceError(f"{info}: names no model; needed their number and a name a line.")
    loaded = [_load_actor(folder, recorded, name, max_faces, number) for number, name in enumerate(names)]
    shortest = min(actor.num_moments for actor in loaded)
    actors = tuple(Actor(actor.name, actor.model, actor.Ms[:shortest], actor.albedo) for actor in loaded)
    return Performance(f"twin of T16 sequence {sequence}", FPS, load_t16_camera(folder / "Cameras.txt"), actors)


def load_t16_camera(path: Path) -> Camera:
    """The camera in T16's `Cameras.txt`: a scale, K in rows, world to camera in rows, mm."""
    with reading(SequenceError, path, "a camera as T16 writes it"):
        numbers = [float(word) for word in path.read_text(encoding="ascii").split()]
    if len(numbers) != 22 or not np.all(np.isfinite(numbers)):
        raise SequenceError(f"{path}: holds {len(numbers)} numbers; needed 22: a scale, 9 of K, 12 of the pose.")
    width, height = IMAGE_SIZE
    T_camera_world = np.eye(4)
    T_camera_world[:3] = np.array(numbers[10:]).reshape(3, 4)
    T_camera_world[:3, 3] *= 1e-3
    K = np.array(numbers[1:10]).reshape(3, 3)
    return Camera("cam0", width, height, K, T_world_camera=se3.inverse(T_camera_world))


def _load_actor(folder: Path, recorded: Path, name: str, max_faces: int | None, number: int) -> Actor:
    motion = next((p for p in (recorded / f"{name}.MOTION.gz", recorded / f"{name}.MOTION") if p.is_file()), None)
    if motion is None:
        raise SequenceError(f"{recorded}: has no {name}.MOTION.gz, which MODELS_INFO.txt names.")
    bones, Ts_world_bone, bind = load_t16_motion(motion)
    model = load_t16_model(folder / "models" / f"{name}.OFF", max_faces, bind)
    if len(bones) != model.skeleton.num_bones:
        raise SequenceError(f"{motion}: moves {len(bones)} bones; {name}.SKEL has {model.skeleton.num_bones}.")
    # Bones are matched by position: objects call them differently in the two files.
    Ms = (Ts_world_bone @ np.linalg.inv(bind))[:, :, :3]
    if model.hand is not None:
        return Actor(model.hand.side, model, Ms, SKIN)
    short = name.removeprefix("Model_Object_").lower()
    return Actor(short, model, Ms, OBJECT_COLORS[number % len(OBJECT_COLORS)])
