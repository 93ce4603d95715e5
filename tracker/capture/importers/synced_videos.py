"""Several videos of one moment, one for each camera, and the calibration of the cameras."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import PurePosixPath
from typing import Any

import numpy as np

from tracker.capture.anipose_calibration import parse_anipose
from tracker.capture.colmap_calibration import parse_colmap
from tracker.capture.dat_calibration import parse_dat
from tracker.capture.document import read_regular_file
from tracker.capture.frame_shifts import NO_SHIFT
from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera, default_name
from tracker.capture.import_question import ImportChoice
from tracker.capture.importers.rgbd_folder import read_intrinsics
from tracker.capture.listed_files import ListedFiles
from tracker.capture.numbered_files import sort_naturally
from tracker.capture.opencv_calibration import find_cameras, parse_opencv
from tracker.capture.video_calibration import MAX_CALIBRATION_BYTES, VideoCamera
from tracker.capture.video_file import VIDEO_SUFFIXES, VideoFile
from tracker.errors import CalibrationError, ImportRefusedError

_DAT = re.compile(r"c([0-9]{1,3})\.dat")
TAKES = ("fps", "hands", "allow_gaps", "color_format")


class SyncedVideos:
    """Importer of videos whose frame n was taken at one moment in all of them."""

    format = "synced_videos"
    turn = 3

    def recognises(self, files: ListedFiles) -> bool:
        return any(name.lower().endswith(VIDEO_SUFFIXES) for name in files.names)

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        found = Findings()
        videos = sort_naturally(name for name in files.names if name.lower().endswith(VIDEO_SUFFIXES))
        if not videos:
            raise ImportRefusedError(f"No videos: needed files of type {', '.join(VIDEO_SUFFIXES)}.")
        if len(videos) > 64:
            raise ImportRefusedError(f"{len(videos)} videos; a recording has at most 64 cameras.")
        calibration, used = read_calibration(files)
        if calibration:
            cameras, takes = _plan_calibrated(files, videos, calibration, options, found)
        elif len(videos) == 1:
            K, lens = read_intrinsics(options, found), np.array(options.distortion or (), dtype=np.float64)
            stream = VideoFile(files.root, videos[0], options.color_format == "png")
            cameras = (PlannedCamera(_make_id(videos[0]), K, lens, color=stream),)
            takes = ("fx", "fy", "cx", "cy", "distortion", *TAKES)
        else:
            raise CalibrationError(
                f"{len(videos)} videos and no calibration: add calibration.toml (Anipose), OpenCV's YAML, JSON or npz, "
                "COLMAP's cameras.txt and images.txt, or c0.dat and rot_trans_c0.dat for each camera."
            )
        found.leave_out([name for name in files.names if name not in {*videos, *used}])
        if len({camera.id.casefold() for camera in cameras}) != len(cameras):
            cameras = tuple(replace(camera, id=f"cam{index}") for index, camera in enumerate(cameras))
            found.warn(
                "The videos have similar names; the cameras are called cam0, cam1, ... in the order of their names."
            )
        return ImportPlan(
            format=self.format,
            name=default_name(files, options),
            fps=options.fps,
            cameras=cameras,
            hands=options.hands if options.hands is not None else ("right",),
            problems=tuple(found.problems),
            warnings=tuple(found.warnings),
            questions=tuple(found.questions),
            takes=takes,
            unit_known=options.world_unit_m is not None or len(cameras) == 1 or find_unit(calibration) is not None,
        )


def _plan_calibrated(
    files: ListedFiles, videos: list[str], calibration: list[VideoCamera], options: ImportOptions, found: Findings
) -> tuple[tuple[PlannedCamera, ...], tuple[str, ...]]:
    """The cameras of a calibration with their videos, and the options that can be told."""
    takes = TAKES if len(videos) == 1 else ("camera_shifts", *TAKES)
    if find_unit(calibration) is None:
        takes = ("world_unit_m", *takes)
    unit = _choose_unit(calibration, options, found)
    matched = match_cameras(videos, calibration, found.warnings)
    cameras = tuple(
        PlannedCamera(
            id=_make_id(video),
            K=camera.K,
            distortion=camera.distortion,
            T_world_camera=camera.find_pose(unit),
            color=VideoFile(files.root, video, options.color_format == "png"),
            calibrated_size=camera.size,
        )
        for video, camera in matched
    )
    _propose_shifts(files, matched, options, found)
    return cameras, takes


def _propose_shifts(
    files: ListedFiles, matched: list[tuple[str, VideoCamera]], options: ImportOptions, found: Findings
) -> None:
    """Propose to shift cameras whose calibration found their videos out of step; nothing is shifted by itself."""
    first = matched[0][1].offset_s
    shifts, told = [], []
    for video, camera in matched[1:]:
        late = camera.offset_s - first
        fps = options.fps or VideoFile(files.root, video).read_header()[0]
        if late * fps and (frames := round(late * fps)):
            shifts.append(f"{_make_id(video)}={frames:+d}")
            told.append(f"{_make_id(video)} by {late * fps:.2f} frames ({1000 * late:.1f} ms)")
    if not shifts:
        return
    apart = f"The calibration found videos out of step: a moment is later in {', '.join(told)}."
    if options.camera_shifts is None:
        found.warn(f"{apart} They are imported as they are unless they are shifted: camera_shifts {','.join(shifts)}.")
    choices = (
        ImportChoice(",".join(shifts), f"Shift by whole frames: {', '.join(shifts)}"),
        ImportChoice(NO_SHIFT, "Leave the videos as they are"),
    )
    found.ask(
        "camera_shifts",
        f"{apart} This applies only if the cameras started in the same way as for the board; otherwise leave them.",
        proposal=choices[0].value,
        proposed_by="found by the calibration of these cameras",
        choices=choices,
    )


def read_calibration(files: ListedFiles) -> tuple[list[VideoCamera], list[str]]:
    """Cameras of whatever calibration lies beside the videos, and the files it was read from."""
    for read_kind in (_read_anipose, _read_colmap, _read_dats, _read_tables):
        cameras, used = read_kind(files)
        if used:
            return cameras, used
    return [], []


def _read(files: ListedFiles, name: str) -> bytes:
    return read_regular_file(files.path(name), MAX_CALIBRATION_BYTES, CalibrationError)


def _read_anipose(files: ListedFiles) -> tuple[list[VideoCamera], list[str]]:
    """Of several, the one highest in the folder: a calibration's report holds its board as `.toml` too."""
    tomls = [name for name in files.names if name.lower().endswith(".toml")]
    tomls = [name for name in tomls if name.count("/") == min(other.count("/") for other in tomls)]
    if len(tomls) > 1:
        raise CalibrationError(f"{len(tomls)} calibrations ({', '.join(tomls[:4])}); leave one in the folder.")
    return [camera for name in tomls for camera in parse_anipose(_read(files, name), name)], tomls


def _read_colmap(files: ListedFiles) -> tuple[list[VideoCamera], list[str]]:
    for name in files.names:
        other = str(PurePosixPath(name).with_name("images.txt"))
        if PurePosixPath(name).name == "cameras.txt" and other in files.names:
            return parse_colmap(_read(files, name), _read(files, other), name), [name, other]
    return [], []


def _read_dats(files: ListedFiles) -> tuple[list[VideoCamera], list[str]]:
    """`c0.dat` with `rot_trans_c0.dat` for each camera; one camera alone needs no place."""
    dats = sort_naturally(name for name in files.names if _DAT.fullmatch(PurePosixPath(name).name))
    cameras, used = [], []
    for name in dats:
        path = PurePosixPath(name)
        other = str(path.with_name(f"rot_trans_{path.name}"))
        extrinsics = _read(files, other) if other in files.names else None
        if extrinsics is None and len(dats) > 1:
            raise CalibrationError(f"{other} is missing; each camera needs its rotation and translation.")
        cameras.append(parse_dat(_read(files, name), extrinsics, path.stem, name))
        used += [name] if extrinsics is None else [name, other]
    return cameras, used


def _read_tables(files: ListedFiles) -> tuple[list[VideoCamera], list[str]]:
    """OpenCV's files: each with cameras of its own, or all together as in intrinsics.yml and extrinsics.yml."""
    tables = {
        n: parse_opencv(_read(files, n), n)
        for n in files.names
        if n.lower().endswith((".yaml", ".yml", ".json", ".npz"))
    }
    found = {name: find_cameras(values, name, PurePosixPath(name).stem) for name, values in tables.items()}
    merged: dict[str, Any] = {}
    for values in tables.values():
        merged |= values
    together = find_cameras(merged, " + ".join(tables)[:200], "camera") if len(tables) > 1 else []
    if len(together) > 1 and max(len(cameras) for cameras in found.values()) > 1:
        return together, list(tables)
    cameras = [camera for name in sort_naturally(tables) for camera in found[name]]
    return cameras, [name for name in tables if found[name]]


def match_cameras(videos: list[str], cameras: list[VideoCamera], warnings: list[str]) -> list[tuple[str, VideoCamera]]:
    """Each video with its camera: by name, by number (`cam0_test.mp4` and `c0`), or else both in order of name."""
    if len(videos) != len(cameras):
        raise CalibrationError(
            f"{len(videos)} videos ({', '.join(videos[:4])}) and {len(cameras)} calibrated cameras "
            f"({', '.join(c.name for c in cameras[:4])}); needed one camera for each video."
        )
    for fits in (_same_name, _name_inside, _same_number):
        if pairs := _pair(videos, cameras, fits):
            return pairs
    order = sort_naturally(camera.name for camera in cameras)
    by_name = {camera.name: camera for camera in cameras}
    if len(by_name) != len(cameras):
        raise CalibrationError(f"Two calibrated cameras have the same name: {', '.join(order[:6])}.")
    pairs = list(zip(videos, order, strict=True))
    if len(videos) > 1:
        shown = ", ".join(f"{video} is {name}" for video, name in pairs)
        warnings.append(f"Videos and calibrated cameras have different names; taken in order: {shown}. Check it.")
    return [(video, by_name[name]) for video, name in pairs]


def _pair(
    videos: list[str], cameras: list[VideoCamera], fits: Callable[[str, str], bool]
) -> list[tuple[str, VideoCamera]]:
    """Each video with the one camera that fits it; empty unless every video has one of its own."""
    pairs = [(video, camera) for video in videos for camera in cameras if fits(video, camera.name)]
    is_whole = [video for video, _ in pairs] == videos and len({id(camera) for _, camera in pairs}) == len(videos)
    return pairs if is_whole else []


def _same_name(video: str, camera: str) -> bool:
    return PurePosixPath(video).stem.casefold() == camera.casefold()


def _name_inside(video: str, camera: str) -> bool:
    """The camera's name stands in the path of the video, not as a part of a longer word or number."""
    plain = re.escape(camera.casefold())
    return re.search(rf"(?<![a-z0-9])(cam(era)?[-_ ]?)?{plain}(?![a-z0-9])", video.casefold()) is not None


def _same_number(video: str, camera: str) -> bool:
    """Both have a number after `cam`, `camera`, `c`, `view`, or alone, and it is the same."""
    numbers = [re.findall(r"(?:camera|cam|view|c)?[-_]?([0-9]+)", t.casefold()) for t in (video, camera)]
    return bool(numbers[0]) and bool(numbers[1]) and int(numbers[0][0]) == int(numbers[1][0])


def find_unit(cameras: list[VideoCamera]) -> float | None:
    """Metres per unit, if the calibration says it."""
    told = {camera.unit_m for camera in cameras}
    return told.pop() if len(told) == 1 else None


def _choose_unit(cameras: list[VideoCamera], options: ImportOptions, found: Findings) -> float:
    """Metres per unit of the calibration; must be told when there is a distance between cameras and it says none."""
    given, told = options.world_unit_m, find_unit(cameras)
    if told is not None:
        if given not in (None, told):
            found.warn(f"The calibration says its unit itself, {told:g} m; the {given:g} m given were not used.")
        return told
    if given is not None:
        return given
    centres = np.array([camera.find_pose(1.0)[:3, 3] for camera in cameras])
    if len(cameras) > 1:
        length = float(np.linalg.norm(centres - centres[0], axis=1).max())
        hint = (
            f"0.001 (millimetres) makes it {length / 1000:.4g} m, 1 makes it {length:.4g} m; "
            "when the unit is a checkerboard square, the side of a square."
        )
        text = (
            f"The unit of the calibration is not known: its cameras are {length:.4g} units apart. Give world_unit_m, "
            f"metres per unit: {hint}"
        )
        likely = next((unit for unit in (0.001, 1.0) if 0.1 <= length * unit <= 5), None)
        by = "" if likely is None else f"it puts the cameras {length * likely:.3g} m apart"
        ask = f"Metres per unit of the calibration, whose cameras are {length:.4g} units apart: {hint}"
        found.refuse(text, "world_unit_m", ask, proposal=likely, proposed_by=by)
    return 1.0 if float(np.abs(centres).max()) < 900 else 0.001


def _make_id(video: str) -> str:
    """A camera id from the name of its video."""
    stem = re.sub(r"[^A-Za-z0-9._-]+", "_", PurePosixPath(video).stem)[:64].strip("._-")
    match = re.match(r"(cam(?:era)?[-_]?[0-9A-Za-z]+)", stem)
    return (match[1] if match else stem) or "cam0"
