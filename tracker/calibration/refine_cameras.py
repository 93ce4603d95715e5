"""Better places of a recording's cameras from the joints that people marked in two or more of them.

The bundle adjustment of the board's calibration (`bundle.adjust`), each joint being a board of one corner. Labels tell
no scale and no place in the world: the first camera stands still, and the baseline to the camera farthest from it keeps
its length.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.calibration.arrangement import Arrangement
from tracker.calibration.bundle import Freedom, Layout, adjust, find_jacobian
from tracker.calibration.camera_certainty import find_covariance, find_pixel_std
from tracker.calibration.joint_marks import JointMarks, read_marks
from tracker.calibration.projection import DISTORTION_PARAMETERS
from tracker.calibration.refinement import Agreement, RefinedCamera, Refinement
from tracker.capture.annotations import Annotations
from tracker.capture.camera import Camera
from tracker.capture.triangulation import OUTLIER_PX, triangulate
from tracker.errors import CalibrationError, say_count

Array = npt.NDArray[np.float64]

LEFT_OUT_EVERY = 5
"""One labelled frame in this many is left out, as the board's calibration leaves out a fifth of the time."""

MIN_JOINTS = 20
"""That a camera must share with others: about one hand. Fewer say hardly more than the five numbers between two
cameras (Hartley and Zisserman, 11.1); whether those say enough is measured (`find_pixel_std`), not counted."""

MAX_UNSURE_PX = OUTLIER_PX
"""One standard deviation of where a camera sees a point, anywhere in its picture: beyond it true marks elsewhere would
be called into question."""

LEAST_GAIN = 0.01
"""Share by which the distance on labels left out must shrink. Of right cameras it changed by -0.5 to +1.7 % (2 to 4
cameras, 40 frames of labels with 1.5 px of noise, six times each)."""


def refine_cameras(cameras: Sequence[Camera], annotations: Annotations, lenses: bool = False) -> Refinement:
    """The cameras moved so that the labels' joints agree in the pictures.

    Args:
        cameras: Of the recording.
        annotations: Its labels; of these the visible joints of independent sources that two cameras or more have.
        lenses: Focal lengths, principal points and five coefficients of distortion may change too.

    Raises:
        CalibrationError: The labels are too few to say anything.
    """
    marks = read_marks(annotations, cameras)
    chosen = _choose_cameras(marks, cameras)
    shared = marks.choose_cameras(chosen)
    frames = np.unique(shared.frame)
    left_out = frames[LEFT_OUT_EVERY // 2 :: LEFT_OUT_EVERY]
    if len(frames) < LEFT_OUT_EVERY:
        raise CalibrationError(
            f"Labels of {say_count(len(frames), 'frame')} have joints in two cameras; needed {LEFT_OUT_EVERY}, of "
            "which one is left out to judge the cameras by. Mark the hand in more frames, in all cameras."
        )
    is_left_out = np.isin(shared.frame, left_out)
    before = [cameras[number] for number in chosen]
    fitting = _Fitting(before, shared.choose(~is_left_out), lenses)
    after = fitting.cameras
    fitted_before, fitted_after, out_before, out_after = (
        triangulate(some, shared.choose(mask).pixels).residuals
        for mask in (~is_left_out, is_left_out)
        for some in (before, after)
    )
    unsure = fitting.find_unsure()
    described = []
    for number, camera in enumerate(cameras):
        if number not in chosen:
            none = Agreement(0, float("nan"), float("nan"))
            described.append(RefinedCamera(camera.id, False, 0.0, 0.0, 0.0, 0.0, none, none, none, none))
            continue
        own = chosen.index(number)
        moved, turned, longer = _compare(before[own], after[own])
        described.append(
            RefinedCamera(
                camera.id,
                own > 0,
                *(moved, turned, longer, unsure[own]),
                *(_summarize(d[:, own]) for d in (fitted_before, fitted_after, out_before, out_after)),
            )
        )
    refined = list(cameras)
    for own, number in enumerate(chosen):
        refined[number] = after[own]
    refusal = _refuse(described, out_before, out_after)
    kept = (
        f"{before[0].id} stands still, and {before[fitting.far].id} stays {1000 * fitting.baseline:.0f} mm from it: "
        "labels give no scale."
    )
    return Refinement(tuple(refined), tuple(described), len(frames) - len(left_out), len(left_out), kept, refusal)


def _choose_cameras(marks: JointMarks, cameras: Sequence[Camera]) -> list[int]:
    """Those that share enough joints with each other, directly or by others; the first of them is the reference."""
    is_seen = marks.is_seen
    shared = is_seen.T.astype(np.int64) @ is_seen.astype(np.int64)  # (C, C)
    is_linked = shared >= MIN_JOINTS
    np.fill_diagonal(is_linked, False)
    groups, left = [], set(range(len(cameras)))
    while left:
        group, edge = set(), {min(left)}
        while edge:
            group |= edge
            edge = {int(c) for c in np.flatnonzero(is_linked[sorted(edge)].any(axis=0))} - group
        groups.append(sorted(group))
        left -= group
    best = max(groups, key=lambda group: (len(group), int(shared[np.ix_(group, group)].sum())))
    if len(best) < 2:
        most = int(np.max(shared - np.diag(np.diag(shared)), initial=0))
        raise CalibrationError(
            f"No two cameras share more than {say_count(most, 'labelled joint')}; needed {MIN_JOINTS}, marked as "
            "visible in one frame of both, by hand. Joints that were triangulated, interpolated or accepted from a "
            "track agree with the cameras they came from and don't count."
        )
    if turned := [cameras[c].id for c in best if cameras[c].distortion.size > DISTORTION_PARAMETERS]:
        raise CalibrationError(
            f"{turned[0]} has {cameras[best[0]].distortion.size} coefficients of distortion; at most "
            f"{DISTORTION_PARAMETERS} can be refined. A tilted sensor is not supported."
        )
    return best


class _Fitting:
    """Cameras fitted to marks.

    Args:
        cameras: C of them, the first is the reference.
        marks: In these cameras.
        lenses: Whether lenses may change too.
    """

    def __init__(self, cameras: Sequence[Camera], marks: JointMarks, lenses: bool) -> None:
        points = triangulate(cameras, marks.pixels).points
        is_placed = np.asarray(np.isfinite(points).all(axis=1))
        points, marks = points[is_placed], marks.choose(is_placed)
        self.corners = marks.to_corners()
        start = _arrange(cameras, points)
        baselines = start.find_baselines()
        self.far = int(np.argmax(baselines))
        self.baseline = float(baselines[self.far])
        self.freedom = Freedom(lenses=lenses, offsets=False, kept_baseline=(self.far, self.baseline))
        self.arrangement = adjust(start, self.corners, self.freedom, OUTLIER_PX)
        self.cameras = [_open(camera, self.arrangement, number) for number, camera in enumerate(cameras)]

    def find_unsure(self) -> list[float]:
        """Of each camera, px: how far its picture may be off anywhere, by what the marks tell (`find_pixel_std`)."""
        here, (count, joints) = self.arrangement, (len(self.cameras), len(self.arrangement.T_world_board))
        layout = Layout(count, joints, self.freedom)
        parameters = layout.size - layout.places
        J = find_jacobian(here, layout, self.corners, self.freedom, np.zeros(layout.size))
        residuals = here.residuals(self.corners)
        spare = max(residuals.size - 3 * joints - parameters + 1, 1)
        # Median absolute deviation of a Gaussian; with few spare measurements residuals are smaller than the noise.
        sigma = float(np.median(np.abs(residuals)) / 0.6745 * np.sqrt(residuals.size / spare))
        covariance = find_covariance(J, layout.places, sigma)
        world = here.T_world_board[:, :3, 3]
        depths = np.median(here.T_camera_world[:, None, 2, :3] @ world.T, axis=2)[:, 0] + here.T_camera_world[:, 2, 3]
        return [find_pixel_std(here, c, self.freedom, covariance, depth) for c, depth in enumerate(depths.tolist())]


def _arrange(cameras: Sequence[Camera], points: Array) -> Arrangement:
    distortion = np.zeros((len(cameras), DISTORTION_PARAMETERS))
    for number, camera in enumerate(cameras):
        distortion[number, : camera.distortion.size] = camera.distortion
    places = np.tile(np.eye(4), (len(points), 1, 1))
    places[:, :3, 3] = points
    return Arrangement(
        np.array([camera.K for camera in cameras], dtype=np.float64),
        distortion,
        np.array([camera.T_camera_world for camera in cameras]),
        places,
        np.zeros(len(cameras)),
        np.array([[camera.width, camera.height] for camera in cameras], dtype=np.float64),
    )


def _open(camera: Camera, arrangement: Arrangement, number: int) -> Camera:
    T, T_camera_world = np.eye(4), arrangement.T_camera_world[number]
    T[:3, :3] = T_camera_world[:3, :3].T
    T[:3, 3] = -T[:3, :3] @ T_camera_world[:3, 3]
    distortion = arrangement.distortion[number]
    # As many coefficients as it had; five where a lens without any got some.
    count = camera.distortion.size or (5 if distortion.any() else 0)
    if distortion[count:].any():
        count = 5
    place = camera.T_world_camera if number == 0 else T  # to the last digit
    return replace(camera, K=arrangement.K[number], distortion=distortion[:count], T_world_camera=place)


def _summarize(distances: Array) -> Agreement:
    """Of marks (P,), px from each to where its camera sees the point that all marks of the joint make; NaN of none."""
    known = distances[np.isfinite(distances)]
    if not len(known):
        return Agreement(0, float("nan"), float("nan"))
    return Agreement(len(known), float(np.sqrt(np.mean(known**2))), float(np.median(known)))


def _compare(before: Camera, after: Camera) -> tuple[float, float, float]:
    """How far a camera moved, mm, turned, degrees, and how much longer its focal length is, %."""
    moved = 1000 * float(np.linalg.norm(after.T_world_camera[:3, 3] - before.T_world_camera[:3, 3]))
    turn = after.T_world_camera[:3, :3] @ before.T_world_camera[:3, :3].T
    # By the sine half the angle, which small turns tell exactly.
    turned = 2 * np.degrees(np.arcsin(min(1.0, float(np.linalg.norm(turn - np.eye(3))) / np.sqrt(8.0))))
    return moved, float(turned), 100 * float(after.K[0, 0] / before.K[0, 0] - 1)


def _refuse(described: Sequence[RefinedCamera], before: Array, after: Array) -> str:
    """Why the cameras should stay as they are, or ''."""
    worst = max(described, key=lambda one: one.unsure_px)
    if worst.unsure_px > MAX_UNSURE_PX:
        return (
            f"The labels lie too close together, or are too few, to tell where {worst.id} stands: somewhere else in "
            f"its picture points could be {worst.unsure_px:.0f} px off (at most {MAX_UNSURE_PX:.0f}). Mark hands far "
            "apart from each other: left and right, near and far, in the corners of the pictures."
        )
    is_known = np.isfinite(before) & np.isfinite(after)
    cost_before, cost_after = (_find_cost(distances[is_known]) for distances in (before, after))
    if not cost_after < (1 - LEAST_GAIN) * cost_before:
        return (
            f"On the labels that were left out the cameras would be no better ({cost_before:.2f} px before, "
            f"{cost_after:.2f} px after). They already agree as well as labels can show."
        )
    return ""


def _find_cost(distances: Array) -> float:
    """The soft L1 distance that `adjust` minimises, as px: one wrong mark does not decide. NaN of none."""
    if not len(distances):
        return float("nan")
    loss = 2 * OUTLIER_PX**2 * (np.sqrt(1 + (distances / OUTLIER_PX) ** 2) - 1)
    return float(np.sqrt(np.mean(loss)))
