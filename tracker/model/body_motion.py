"""Motions of a body as AMASS keeps them, an .npz with 156 numbers a frame: read, every array checked, and written."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from tracker.errors import ModelFileError, reads
from tracker.model.blend_model import Array
from tracker.model.body_hands import NUM_BODY_JOINTS, NUM_FINGER_JOINTS
from tracker.model.npz_arrays import NpzFields, read_foreign_npz
from tracker.model.npz_files import write_plain_npz

NUM_JOINTS = NUM_BODY_JOINTS + 2 * NUM_FINGER_JOINTS
NUMBERS = 3 * NUM_JOINTS
"""Of a frame: rotation vectors of the root, 21 joints of the body, 15 of the left hand, 15 of the right."""
MAX_FRAMES = 200_000
"""Of a motion; a bound of ours."""
MAX_ANGLE = 20.0
"""Largest component of a rotation vector, rad: some turns more than a whole one are on record."""
MAX_PLACE = 1000.0
"""Of a translation, m."""
MAX_SHAPE = 30.0
"""Standard deviations; a bound of ours."""
MAX_SHAPES = 400
"""Coefficients; SMPL+H has 16, SMPL-X up to 400."""
MAX_FPS = 1000.0
"""A bound of ours."""

NEEDED = f"an AMASS-like motion: 'poses', frames x {NUMBERS}, rad; 'trans', frames x 3, m; 'betas'; 'mocap_framerate'"


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """Poses of one person, frame after frame.

    Attributes:
        poses: (T, 52, 3) rotation vectors in SMPL-H's order, the root's about its joint, rad.
        translations: (T, 3) m.
        shape: (S,) coefficients of the shape.
        fps: Frames per second.
        population: "neutral", "male" or "female": whose shape space the coefficients are of.
    """

    poses: Array
    translations: Array
    shape: Array = field(default_factory=lambda: np.zeros(0))
    fps: float = 30.0
    population: str = "neutral"

    def __post_init__(self) -> None:
        assert self.poses.shape == (len(self.poses), NUM_JOINTS, 3) and self.translations.shape == (len(self.poses), 3)

    def __len__(self) -> int:
        return len(self.poses)


@reads(ModelFileError, NEEDED)
def load_body_motion(path: Path) -> BodyMotion:
    """Read a motion; objects in the file stay unread, and no array is larger than what is said here.

    Raises:
        ModelFileError: No such motion; says what was found and what is needed.
    """
    path = Path(path)
    if not path.is_file():
        raise ModelFileError(path, "no such file", NEEDED)
    fields = NpzFields(path, read_foreign_npz(path))
    poses = fields.numbers("poses", (-1, NUMBERS), MAX_ANGLE)
    if not 1 <= len(poses) <= MAX_FRAMES:
        raise ModelFileError(path, f"{len(poses)} frames", f"1 to {MAX_FRAMES}")
    count = len(poses)
    translations = fields.numbers("trans", (count, 3), MAX_PLACE) if "trans" in fields else np.zeros((count, 3))
    shape = fields.numbers("betas", (-1,), MAX_SHAPE) if "betas" in fields else np.zeros(0)
    if len(shape) > MAX_SHAPES:
        raise ModelFileError(path, f"{len(shape)} 'betas'", f"at most {MAX_SHAPES}")
    poses = poses.reshape(count, NUM_JOINTS, 3)
    return BodyMotion(poses, translations, shape, _read_fps(fields), _read_gender(fields))


def save_body_motion(motion: BodyMotion, path: Path) -> None:
    """Write a motion with AMASS's names; the file appears whole or not at all. Equal motions give equal bytes."""
    write_plain_npz(
        Path(path),
        {
            "poses": motion.poses.reshape(len(motion), NUMBERS),
            "trans": motion.translations,
            "betas": motion.shape,
            "mocap_framerate": np.array(motion.fps),
            "gender": np.array(motion.population),
        },
    )


def _read_fps(fields: NpzFields) -> float:
    for name in ("mocap_framerate", "mocap_frame_rate"):
        if name in fields:
            fps = fields.numbers(name, (), MAX_FPS).item()
            if fps <= 0.0:
                raise ModelFileError(fields.path, f"'{name}' of {fps:g}", "frames per second above 0")
            return fps
    return 30.0


def _read_gender(fields: NpzFields) -> str:
    if "gender" not in fields:
        return "neutral"
    text = fields.text("gender")
    if text not in ("neutral", "male", "female"):
        raise ModelFileError(fields.path, f"gender {text[:40]!r}", "neutral, male or female")
    return text
