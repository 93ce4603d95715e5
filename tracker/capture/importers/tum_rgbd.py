"""Recordings in the layout of the TUM RGB-D benchmark: `rgb.txt`, `depth.txt` and the images they list.

Depth is in units of 1/5000 m. Colour and depth were not taken at the same moment: each depth image gets the colour
image nearest in time, at most 20 ms away, each image used once.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.document import read_regular_file
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_findings import Findings, show_first
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera, default_name
from tracker.capture.import_question import ImportChoice
from tracker.capture.importers.rgbd_folder import read_intrinsics
from tracker.capture.listed_files import ListedFiles
from tracker.capture.relative_path import find_path_fault
from tracker.errors import ImportRefusedError

TAKES = ("intrinsics", "fx", "fy", "cx", "cy", "depth_scale", "fps", "hands", "allow_gaps", "distortion")
MAX_DIFFERENCE_S = 0.020
"""Between the times of a colour and a depth image of one frame, s: the default of TUM's `associate.py`."""
DEPTH_SCALE = 1 / 5000
"""m per unit of TUM's depth images."""
MAX_LIST_BYTES = 64 * 1024 * 1024
"""Of rgb.txt or depth.txt; a bound of ours."""

# fx, fy, cx, cy px and distortion, as the benchmark publishes them for its three cameras and for ROS's default.
CAMERAS: dict[str, tuple[tuple[float, float, float, float], tuple[float, ...]]] = {
    "freiburg1": ((517.3, 516.5, 318.6, 255.3), (0.2624, -0.9531, -0.0054, 0.0026, 1.1633)),
    "freiburg2": ((520.9, 521.0, 325.1, 249.7), (0.2312, -0.7849, -0.0033, -0.0001, 0.9172)),
    "freiburg3": ((535.4, 539.2, 320.1, 247.6), ()),
    "ros_default": ((525.0, 525.0, 319.5, 239.5), ()),
}


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Names (N) of depth and colour images taken together, the depth images' times (N,) s, and names of the others."""

    depth: tuple[str, ...]
    color: tuple[str, ...]
    times: npt.NDArray[np.float64]
    left_out: tuple[str, ...]


class TumRgbd:
    """Importer of TUM RGB-D recordings; intrinsics by options or, when told, those of one of its cameras."""

    format = "tum_rgbd"
    turn = 2

    def recognises(self, files: ListedFiles) -> bool:
        return "depth.txt" in files.names and "rgb.txt" in files.names

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        found = Findings()
        pairs = _pair_images(files, options, found)
        for name in ("groundtruth.txt", "accelerometer.txt"):
            if name in files.names:
                found.warn(f"{name} is not used; the camera stands at the origin of the world.")
        options = _choose_camera(options)
        camera = PlannedCamera(
            id="cam0",
            K=read_intrinsics(options, found),
            distortion=np.array(options.distortion or (), dtype=np.float64),
            color=ImageFiles(files.root, pairs.color, False),
            depth=ImageFiles(files.root, pairs.depth, True),
            depth_scale=options.depth_scale or DEPTH_SCALE,
            timestamps=pairs.times - pairs.times[0],
        )
        if options.intrinsics is None and camera.K is None:
            text = f"Or name the benchmark's camera with intrinsics: {', '.join(CAMERAS)}."
            choices = tuple(ImportChoice(name, name) for name in CAMERAS)
            ask = "The camera that the benchmark's recording was made with; its published values fill the fields."
            found.refuse(text, "intrinsics", ask, is_required=False, choices=choices)
        return ImportPlan(
            format=self.format,
            name=default_name(files, options),
            fps=options.fps,
            cameras=(camera,),
            hands=options.hands if options.hands is not None else ("right",),
            problems=tuple(found.problems),
            warnings=tuple(found.warnings),
            questions=tuple(found.questions),
            takes=TAKES,
            left_out=pairs.left_out,
        )


def _pair_images(files: ListedFiles, options: ImportOptions, found: Findings) -> _Pairs:
    """Each depth image with the colour image nearest in time; what has no partner is left out."""
    color_times, color_names = _read_list(files, "rgb.txt")
    depth_times, depth_names = _read_list(files, "depth.txt")
    partner = associate(depth_times, color_times, MAX_DIFFERENCE_S)
    alone = np.flatnonzero(partner < 0)
    left_out = [depth_names[i] for i in alone]
    if alone.size:
        found.miss(
            f"{alone.size} of {len(depth_names)} depth images have no colour image within "
            f"{MAX_DIFFERENCE_S * 1000:g} ms ({show_first(left_out, 3)}).",
            options.allow_gaps,
            allowed="They are left out.",
            refused="Allow gaps to leave them out.",
            ask="They can be left out.",
        )
    kept = np.flatnonzero(partner >= 0)
    if not kept.size:
        raise ImportRefusedError("No depth image has a colour image close in time; do both lists use the same clock?")
    used = set(partner[kept].tolist())
    if unused := [name for index, name in enumerate(color_names) if index not in used]:
        found.warn(f"{len(unused)} of {len(color_names)} colour images belong to no depth image and are left out.")
    lag = np.abs(depth_times[kept] - color_times[partner[kept]]) * 1000
    found.warn(f"Colour is up to {lag.max():.1f} ms away from depth (median {np.median(lag):.1f} ms).")
    return _Pairs(
        depth=tuple(depth_names[i] for i in kept),
        color=tuple(color_names[i] for i in partner[kept]),
        times=depth_times[kept],
        left_out=(*left_out, *unused),
    )


def associate(first: npt.NDArray[np.float64], second: npt.NDArray[np.float64], most: float) -> npt.NDArray[np.int64]:
    """For each time (N,) of the first the index of its partner in the second (M,), ascending both, or -1.

    Closest pairs are joined first; no time has two partners; nothing further apart than `most`.
    """
    lows = np.searchsorted(second, first - most, "left")
    highs = np.searchsorted(second, first + most, "right")
    pairs = [
        (abs(first[i] - second[j]), i, j)
        for i in range(len(first))
        for j in range(lows[i], min(highs[i], lows[i] + 64))
    ]
    partner = np.full(len(first), -1, np.int64)
    taken = np.zeros(len(second), bool)
    for _, i, j in sorted(pairs):
        if partner[i] < 0 and not taken[j]:
            partner[i], taken[j] = j, True
    return partner


def _choose_camera(options: ImportOptions) -> ImportOptions:
    """Options with the benchmark's camera in place of what was not said; untouched when none was named."""
    if options.intrinsics is None:
        return options
    (fx, fy, cx, cy), distortion = CAMERAS[options.intrinsics]
    own_focal = options.fx is not None
    return replace(
        options,
        fx=options.fx or fx,
        fy=options.fy if own_focal or options.fy is not None else fy,
        cx=cx if options.cx is None else options.cx,
        cy=cy if options.cy is None else options.cy,
        distortion=distortion if options.distortion is None else options.distortion,
    )


def _read_list(files: ListedFiles, name: str) -> tuple[npt.NDArray[np.float64], list[str]]:
    """Times (N,) s, ascending, and names of a list file."""
    if name not in files.names:
        raise ImportRefusedError(f"{name} is missing; a TUM RGB-D folder lists its images in rgb.txt and depth.txt.")
    data = read_regular_file(files.path(name), MAX_LIST_BYTES, ImportRefusedError)
    entries: list[tuple[float, str]] = []
    for number, line in enumerate(data.decode("utf-8", "replace").splitlines(), 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        parts = line.split()
        try:
            time = float(parts[0])
        except ValueError:
            time = float("nan")
        if len(parts) != 2 or not 0 <= time < 1e12:
            raise ImportRefusedError(f"{name}, line {number}: is {line[:80]!r}; needed a time in s and a file name.")
        if fault := find_path_fault(parts[1]):
            raise ImportRefusedError(f"{name}, line {number}: the file name {parts[1][:80]!r} {fault}.")
        entries.append((time, parts[1]))
    times = np.array([time for time, _ in entries])
    if len(entries) == 0:
        raise ImportRefusedError(f"{name}: lists no images.")
    if (np.diff(times) <= 0).any():
        worst = int(np.flatnonzero(np.diff(times) <= 0)[0])
        raise ImportRefusedError(f"{name}: times do not increase at {entries[worst + 1][1]}.")
    return times, [image for _, image in entries]
