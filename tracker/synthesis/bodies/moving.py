"""People who move before a scanner of 60 frames a second: hands are fast, and missing when they are."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation, Slerp

from tracker.model.body_hands import body_hand
from tracker.synthesis.bodies.body_poses import a_pose, draw_hand, draw_pose
from tracker.synthesis.bodies.generate import BODY_SCANNER, SIDES, GeneratedBody, scan_person
from tracker.synthesis.bodies.hand_poses import MIRRORED, find_poses
from tracker.synthesis.bodies.person import Person, make_person
from tracker.synthesis.scans.scanner import Scanner

Array = npt.NDArray[np.float64]


@dataclass(frozen=True)
class MovingOptions:
    """How a moving scan is made.

    Attributes:
        still: Frames in which the person stands in the A-pose first, hands flat.
        body_frames: Frames from one pose of the body to the next.
        hand_frames: Frames from one pose of a hand to the next.
        missing: Share of the frames in which a hand is not in the scan, when it moves fastest.
        spell: Fewest and most frames of a gap.
        wildness: Share of the range of poses that is used.
    """

    still: int = 12
    body_frames: int = 45
    hand_frames: int = 25
    missing: float = 0.2
    spell: tuple[int, int] = (5, 14)
    wildness: float = 0.7


@dataclass(frozen=True, eq=False)
class MovingPerson:
    """A motion and which hands the scanner loses.

    Attributes:
        person: Who.
        poses: (T, 52, 3) rad.
        translations: (T, 3) m.
        is_missing: (T, 2) left and right.
    """

    person: Person
    poses: Array
    translations: Array
    is_missing: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        return len(self.poses)

    def scan(self, t: int, scanner: Scanner = BODY_SCANNER) -> GeneratedBody:
        """The scan of a frame; always the same."""
        shown = {side: not bool(self.is_missing[t, k]) for k, side in enumerate(SIDES)}
        rng = np.random.default_rng([self.person.number, t, 29])
        name = f"{t:06d}"
        return scan_person(self.person, self.poses[t], self.translations[t], shown, scanner, rng, name)


def make_motion(number: int, frames: int, seed: int = 0, options: MovingOptions | None = None) -> MovingPerson:
    """A person who stands in the A-pose and then moves; the same arguments make the same motion.

    Args:
        number: Of the person.
        frames: T, meant for 60 a second.
        seed: Of another motion.
        options: See `MovingOptions`.
    """
    options = options or MovingOptions()
    rng = np.random.default_rng([number, seed, 31])
    person = make_person(number)
    flat = find_poses("flat_together")[0]
    first = a_pose()
    first[0, 1] = rng.uniform(-np.pi, np.pi)
    for side in SIDES:
        first[body_hand(person.model, side).fingers] = flat if side == "right" else flat * MIRRORED
    keys, times = [first, first], [0, options.still]
    while times[-1] < frames:
        pose = draw_pose(person, rng, options.wildness)
        pose[0, 1] = keys[-1][0, 1] + rng.uniform(-0.5, 0.5)
        keys.append(pose)
        times.append(times[-1] + options.body_frames)
    poses = _interpolate(np.array(keys), times, frames)
    for side in SIDES:
        fingers = body_hand(person.model, side).fingers
        keys, times = [first[fingers]] * 2, [0, options.still]
        while times[-1] < frames:
            keys.append(draw_hand(side, rng))
            times.append(times[-1] + options.hand_frames)
        poses[:, fingers] = _interpolate(np.array(keys), times, frames)
    translations = np.zeros((frames, 3))
    for t in range(frames):
        vertices, _ = person.posed(poses[t], np.zeros(3))
        translations[t, 1] = -vertices[:, 1].min()
    return MovingPerson(person, poses, translations, _lose_hands(person, poses, options, rng))


def _interpolate(keys: Array, times: list[int], frames: int) -> Array:
    """(T, J, 3) rotation vectors that go from key (K, J, 3) to key, at rest at each."""
    moments = np.arange(frames, dtype=np.float64)
    for begin, end in pairwise(times):
        inside = (moments >= begin) & (moments <= end)
        share = (np.arange(frames)[inside] - begin) / max(end - begin, 1)
        moments[inside] = begin + (end - begin) * share**3 * (10.0 + share * (6.0 * share - 15.0))
    moved = np.empty((frames, keys.shape[1], 3))
    for joint in range(keys.shape[1]):
        moved[:, joint] = Slerp(times, Rotation.from_rotvec(keys[:, joint]))(moments).as_rotvec()
    return moved


def _lose_hands(
    person: Person, poses: Array, options: MovingOptions, rng: np.random.Generator
) -> npt.NDArray[np.bool_]:
    """(T, 2) gaps about the frames in which each hand is fastest, never while the person stands still."""
    frames = len(poses)
    is_missing = np.zeros((frames, 2), dtype=bool)
    for k, side in enumerate(SIDES):
        hand = body_hand(person.model, side)
        tips = np.array([person.model.pose_at(pose, rest=person.rest).joints[hand.fingers[2::3]] for pose in poses])
        speed = np.linalg.norm(np.gradient(tips, axis=0), axis=2).mean(axis=1)
        speed[: options.still] = -1.0
        while is_missing[:, k].mean() < options.missing and speed.max() > 0.0:
            middle, length = int(np.argmax(speed)), int(rng.integers(options.spell[0], options.spell[1] + 1))
            first, last = max(middle - length // 2, options.still), min(middle + length - length // 2, frames)
            is_missing[first:last, k] = True
            speed[max(first - 6, 0) : last + 6] = -1.0
    return is_missing
