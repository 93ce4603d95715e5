"""A board that somebody waves in front of cameras whose places are known: its corners, or rendered pictures of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import cv2
import numpy as np
import numpy.typing as npt

from tracker.calibration.board import Board
from tracker.calibration.board_pattern import draw_board
from tracker.calibration.board_pose import find_board_poses
from tracker.calibration.camera_pair import SeenBoards
from tracker.calibration.lens import Lens
from tracker.calibration.sightings import Sightings
from tracker.capture.camera import Camera
from tracker.geometry.se3 import exp, inverse, transform

Array = npt.NDArray[np.float64]

BOARD = Board("charuco", 7, 5, 0.04, 0.03, "DICT_5X5_100")
TARGET = np.array([0.0, 0.0, 1.0])
"""Where the board is waved, m; the first camera looks at it along z."""

DRAWN_PER_M, DRAWN_MARGIN_PX = 4000.0, 40


@dataclass(frozen=True, eq=False)
class Filmed:
    """Cameras, and how they filmed.

    Attributes:
        cameras: The world is the first one's frame.
        fps: Of each.
        offsets: (C,) s that a moment is later in each video than in the first.
        seconds: Length of each video.
        board: What was filmed.
    """

    cameras: tuple[Camera, ...]
    fps: tuple[float, ...]
    offsets: Array
    seconds: tuple[float, ...]
    board: Board = BOARD

    def times(self, number: int) -> Array:
        """(F,) s in the camera's own video."""
        return np.arange(int(self.seconds[number] * self.fps[number])) / self.fps[number]

    def pixels(self, number: int) -> Array:
        """(F, N, 2) px without noise; NaN where a corner is not seen, all NaN when fewer than half of them are."""
        return self.pixels_at(number, self.times(number))

    def pixels_at(self, number: int, times: Array) -> Array:
        """The same at any times (F,), s, in the camera's own video."""
        camera = self.cameras[number]
        found = []
        for moment in times - self.offsets[number]:
            T = place_board(self.board, moment)
            points = transform(T, self.board.corners)
            pixels = camera.project(points)
            faces = (camera.T_camera_world @ T)[2, 2] > 0.25
            inside = (pixels > 4).all(axis=1) & (pixels < [camera.width - 5, camera.height - 5]).all(axis=1)
            is_seen = inside & faces
            found.append(np.where((is_seen & (is_seen.mean() > 0.5))[:, None], pixels, np.nan))
        return np.array(found)

    def sight(self, number: int, rng: np.random.Generator, noise_px: float = 0.2) -> Sightings:
        """What a detector would find, with Gaussian noise."""
        pixels = self.pixels(number)
        frames = np.flatnonzero(np.isfinite(pixels).any(axis=(1, 2)))
        noisy = pixels[frames] + noise_px * rng.normal(size=pixels[frames].shape)
        camera = self.cameras[number]
        return Sightings(camera.id, camera.width, camera.height, self.fps[number], self.times(number), frames, noisy)

    def sight_all(self, seed: int = 0, noise_px: float = 0.2) -> list[Sightings]:
        rng = np.random.default_rng(seed)
        return [self.sight(number, rng, noise_px) for number in range(len(self.cameras))]

    def render(self, number: int, frame: int) -> npt.NDArray[np.uint8]:
        """The picture (H, W), grey, of a frame: the board on a grey wall, smoothed as by a lens."""
        camera = self.cameras[number]
        moment = float(self.times(number)[frame] - self.offsets[number])
        T_camera_board = camera.T_camera_world @ place_board(self.board, moment)
        rays = self._rays[number]
        normal, origin = T_camera_board[:3, 2], T_camera_board[:3, 3]
        depth = (normal @ origin) / (rays @ normal)
        on_board = (rays * depth[:, None] - origin) @ T_camera_board[:3, :2]
        where = (
            (on_board * DRAWN_PER_M + DRAWN_MARGIN_PX - 0.5).astype(np.float32).reshape(camera.height, camera.width, 2)
        )
        image = cv2.remap(
            _draw(self.board),
            where[..., 0],
            where[..., 1],
            cv2.INTER_AREA,
            borderMode=cv2.BORDER_CONSTANT,
            borderValue=110.0,
        )
        return cv2.GaussianBlur(image, (0, 0), 0.8).astype(np.uint8)

    @cached_property
    def _rays(self) -> list[Array]:
        """(H * W, 3) of each camera, through every pixel, z = 1; found once, for to undo a lens takes long."""
        rays = []
        for camera in self.cameras:
            everywhere = np.indices((camera.height, camera.width))[::-1].reshape(2, -1).T.astype(np.float64)
            flat_rays = cv2.undistortPoints(everywhere[:, None], camera.K, camera.distortion)[:, 0]
            rays.append(np.column_stack([flat_rays, np.ones(len(flat_rays))]))
        return rays


@cache
def _draw(board: Board) -> npt.NDArray[np.uint8]:
    return draw_board(board, DRAWN_PER_M, margin_px=DRAWN_MARGIN_PX)


def place_board(board: Board, moment: float) -> Array:
    """T_world_board (4, 4) at a moment, s: waved about the target, turned and tilted, never at rest."""
    t = moment
    sway = np.array([0.24 * np.sin(0.9 * t), 0.15 * np.sin(1.3 * t + 1.0), 0.2 * np.sin(0.7 * t + 2.0)])
    turn = np.array([0.5 * np.sin(1.1 * t), 0.5 * np.sin(0.8 * t + 0.5), 0.6 * np.sin(0.6 * t)])
    T = exp(np.concatenate([np.zeros(3), turn]))
    T[:3, 3] = TARGET + sway - T[:3, :3] @ (np.array([*board.size_m, 0.0]) / 2)
    return T


def make_camera(name: str, angle: float, height: float, focal: float, size: tuple[int, int] = (1280, 720)) -> Camera:
    """A camera about a metre from the target, `angle` (rad) around it and `height` (m) above, looking at it."""
    centre = TARGET + np.array([np.sin(angle), -height, -np.cos(angle)])
    z = (TARGET - centre) / np.linalg.norm(TARGET - centre)
    x = np.cross([0.0, 1.0, 0.0], z)
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = np.column_stack([x, np.cross(z, x), z]), centre
    K = np.array([[focal, 0, size[0] / 2 + 7.0], [0, focal * 1.002, size[1] / 2 - 5.0], [0, 0, 1]])
    return Camera(name, size[0], size[1], K, np.array([-0.12, 0.05, 0.0006, -0.0004, 0.0]), T)


def film(
    count: int = 4,
    offsets_s: tuple[float, ...] = (),
    fps: float = 30.0,
    seconds: float = 12.0,
    board: Board = BOARD,
    size: tuple[int, int] = (1280, 720),
    spread: float = 1.1,
) -> Filmed:
    """`count` cameras in an arc of `spread` (rad) to both sides of the first one, which is at the origin."""
    angles = np.linspace(0.0, spread, count) * np.where(np.arange(count) % 2 == 0, 1, -1)
    cameras = [
        make_camera(f"cam{k}", float(angles[k]), 0.12 * (k % 3) if k else 0.0, size[0] * (0.75 + 0.03 * (k % 4)), size)
        for k in range(count)
    ]
    first = inverse(cameras[0].T_world_camera)
    assert np.allclose(first, np.eye(4), atol=1e-9)
    offsets = np.array(offsets_s) if offsets_s else np.zeros(count)
    return Filmed(tuple(cameras), (fps,) * count, offsets, (seconds,) * count, board)


def measure_places(found: tuple[Camera, ...], truth: tuple[Camera, ...]) -> tuple[Array, Array]:
    """Distance of the centres, m, and angle between the cameras, degrees, (C,) each, in the first camera's frame."""
    apart, turned = [], []
    for ours, theirs in zip(found, truth, strict=True):
        T = inverse(theirs.T_world_camera) @ ours.T_world_camera
        apart.append(np.linalg.norm(ours.T_world_camera[:3, 3] - theirs.T_world_camera[:3, 3]))
        turned.append(np.degrees(np.arccos(np.clip((np.trace(T[:3, :3]) - 1) / 2, -1, 1))))
    return np.array(apart), np.array(turned)


def seen_by(filmed: Filmed, noise_px: float = 0.0) -> list[SeenBoards]:
    """What every camera saw, with the board's pose in each frame."""
    lenses = [Lens(camera.K, camera.distortion) for camera in filmed.cameras]
    return [
        SeenBoards(seen, lens, find_board_poses(filmed.board, lens, seen.corners))
        for seen, lens in zip(filmed.sight_all(noise_px=noise_px), lenses, strict=True)
    ]
