"""A folder of videos taken as a recording as it is: nothing is unpacked and nothing is stored."""

from __future__ import annotations

import logging
from collections.abc import Hashable
from pathlib import Path

import numpy as np

from tracker.capture.import_check import examine
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import StreamProbe
from tracker.capture.importers.synced_videos import SyncedVideos
from tracker.capture.listed_files import list_files
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import SEQUENCE_FILE, Sequence, load_sequence
from tracker.capture.video_file import VIDEO_SUFFIXES, VideoFile
from tracker.errors import ImportRefusedError

log = logging.getLogger(__name__)


def open_recording(path: Path, options: ImportOptions | None = None) -> Sequence:
    """The recording in a folder; a folder of videos with their calibration, or one video, is one as it is.

    Args:
        path: A folder with a `sequence.json`, a folder of videos, or a video.
        options: What videos do not tell; nothing may be given for a folder with a `sequence.json`.

    Raises:
        TrackerError: It is none, or something about the videos has to be told or mended first.
    """
    options = options or ImportOptions()
    is_film = path.is_file() and path.name.lower().endswith(VIDEO_SUFFIXES)
    is_stored = path.is_dir() and (path / SEQUENCE_FILE).exists()
    if not is_film and (is_stored or not path.is_dir() or not SyncedVideos().recognises(list_files(path))):
        if told := ", ".join(options.to_json()):
            raise ImportRefusedError(f"{path}: holds no videos. Leave out {told}, which are for videos only.")
        return load_sequence(path)
    return open_films(path, options)


def open_films(source: Path, options: ImportOptions) -> Sequence:
    """Videos of one moment as a recording whose cameras have films.

    Calibration, sizes, rates and counts are checked as an import checks them, but of each video only the header, the
    first and the last frame are looked at; one that breaks in between is told when that frame is asked for.

    Raises:
        ImportRefusedError: What is wrong or has to be told, all of it.
    """
    probes: dict[Hashable, StreamProbe] = {}
    files = list_files(source)
    for name in files.names:
        if name.lower().endswith(VIDEO_SUFFIXES):
            video = VideoFile(files.root, name)
            probes[video] = video.look()
    checked = examine(source, SyncedVideos.format, options, probes)
    plan, report = checked.plan, checked.report
    if plan is None or not report.ok:
        raise ImportRefusedError(" ".join(report.problems))
    for warning in report.warnings:
        log.warning("%s: %s", source, warning)
    cameras = []
    for camera in plan.cameras:
        video, K = camera.color, camera.K
        assert isinstance(video, VideoFile) and K is not None, "the check lets nothing else pass"
        cameras.append(
            RecordedCamera(
                camera.id,
                *checked.sizes[camera.id],
                np.asarray(K, dtype=np.float64),
                camera.distortion,
                camera.T_world_camera,
                film=video.name,
            )
        )
    assert report.fps is not None
    return Sequence(files.root, plan.name, report.fps, report.frame_count, tuple(cameras), plan.hands)
