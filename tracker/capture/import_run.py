"""Import a recording: all of it or nothing."""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import islice
from pathlib import Path

import numpy as np

from tracker.capture.annotations import save_annotations
from tracker.capture.document import read_regular_file
from tracker.capture.frame_pattern import FramePattern
from tracker.capture.import_check import CheckedImport, examine
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImageStream, ImportPlan, PlannedCamera, Progress, SourceImage
from tracker.capture.import_report import ImportReport
from tracker.capture.object_units import MeasureMesh
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence, save_sequence_json
from tracker.capture.workplace import make_workplace
from tracker.errors import ImportRefusedError, TrackerError, say_count

ANNOTATIONS_FILE = "annotations.json"
SOURCES_FILE = "sources.json"
MAX_OTHER_FILE = 1024 * 1024 * 1024
"""Bytes of a file that is no image; a bound of ours."""


@dataclass(frozen=True)
class StoredSource:
    """Where a stored image came from.

    Attributes:
        file: Relative name in the recording.
        source: Original relative name; `#n` is frame n of a video.
        sha256: Of the stored file.
        timestamp: s, from the source, or None.
    """

    file: str
    source: str
    sha256: str
    timestamp: float | None = None


def run_import(
    source: Path | str,
    destination: Path | str,
    format: str | None = None,
    options: ImportOptions | None = None,
    progress: Progress | None = None,
    measure: MeasureMesh | None = None,
) -> ImportReport:
    """Import a recording as a recording folder; every image is decoded on the way.

    The folder appears whole or not at all, also when the process is killed; a refusal is an ImportRefusedError.

    Args:
        source: Folder of the recording, or a single video; it is only read.
        destination: Folder to make; nothing may be there.
        format: One of IMPORT_FORMATS, or None to recognise it.
        options: What the files do not tell.
        progress: Called with what is being done and the share that is done.
        measure: Tells the size of objects' meshes, whose unit is then stored.
    """
    source, destination = Path(source), Path(destination)
    if os.path.lexists(destination):
        raise ImportRefusedError(f"{destination}: something is there already; choose another name.")
    progress = progress or _say_nothing
    progress("check", 0.0)
    checked = examine(source, format, options or ImportOptions(), measure=measure)
    if not checked.report.ok or checked.plan is None:
        raise ImportRefusedError(" ".join(checked.report.problems))
    try:
        with make_workplace(destination) as folder:
            _fill(folder, checked, progress)
    except ImportRefusedError:
        raise
    except TrackerError as fault:
        raise ImportRefusedError(str(fault)) from fault
    except OSError as cause:
        what = cause.strerror or cause
        raise ImportRefusedError(f"{destination}: cannot be written ({what}); nothing was imported.") from cause
    progress("done", 1.0)
    return checked.report


def _say_nothing(stage: str, share: float) -> None:
    """Progress for callers who did not ask for it."""


def _fill(folder: Path, checked: CheckedImport, progress: Progress) -> None:
    """Write the whole recording into the folder."""
    plan, report = checked.plan, checked.report
    assert plan is not None and report.fps is not None
    sources: dict[str, dict[str, list[StoredSource]]] = {}
    cameras: list[RecordedCamera] = []
    total = report.frame_count * sum(1 for camera in plan.cameras for _ in camera.streams())
    done = 0
    for camera in plan.cameras:
        size, times, patterns = checked.sizes[camera.id], checked.times[camera.id], {}
        base = "" if len(plan.cameras) == 1 else f"{camera.id}/"
        for kind, stream in camera.streams():
            pattern = patterns[kind] = FramePattern(f"{base}{kind}/", 6, stream.suffix)
            (folder / pattern.path(0)).parent.mkdir(parents=True)
            stored = sources.setdefault(camera.id, {}).setdefault(kind, [])
            for index, image in enumerate(_read_whole(stream, f"{camera.id} {kind}", size, report.frame_count)):
                (folder / pattern.path(index)).write_bytes(image.data)
                time = float(times[index]) if index < len(times) else None
                digest = hashlib.sha256(image.data).hexdigest()
                stored.append(StoredSource(pattern.path(index), image.source, digest, time))
                done += 1
                progress(f"{camera.id} {kind}", done / total)
        cameras.append(_make_camera(camera, size, patterns))
    _copy_others(folder, checked.root, plan)
    if plan.annotations is not None:
        save_annotations(folder / ANNOTATIONS_FILE, plan.annotations)
    sequence = Sequence(
        folder,
        plan.name,
        report.fps,
        report.frame_count,
        tuple(cameras),
        plan.hands,
        plan.objects,
        None if plan.annotations is None else ANNOTATIONS_FILE,
        plan.gravity,
        plan.planes,
    )
    save_sequence_json(sequence)
    document = {
        "version": 1,
        "format": plan.format,
        "left_out": list(report.left_out),
        "cameras": {c: {k: [asdict(s) for s in stored] for k, stored in own.items()} for c, own in sources.items()},
    }
    _write_json(folder / SOURCES_FILE, document)
    _write_json(folder / "import_report.json", report.to_json())


def _read_whole(stream: ImageStream, what: str, size: tuple[int, int], count: int) -> Iterator[SourceImage]:
    """So many images of one size (width, height) px; an ImportRefusedError at the first that differs or is missing."""
    read = 0
    for image in islice(stream.read(), count):
        if image.size != size:
            found = f"{image.size[0]}x{image.size[1]}"
            raise ImportRefusedError(f"{image.source}: is {found} px where the others are {size[0]}x{size[1]} px.")
        yield image
        read += 1
    if read != count:
        text = f"{what}: {say_count(read, 'frame')} where the check had found {count}"
        raise ImportRefusedError(f"{text}; has the source changed?")


def _make_camera(camera: PlannedCamera, size: tuple[int, int], patterns: dict[str, FramePattern]) -> RecordedCamera:
    assert camera.K is not None
    return RecordedCamera(
        id=camera.id,
        width=size[0],
        height=size[1],
        K=np.asarray(camera.K, dtype=np.float64),
        distortion=camera.distortion,
        T_world_camera=camera.T_world_camera,
        color=patterns.get("color"),
        depth=patterns.get("depth"),
        depth_scale=camera.depth_scale if camera.depth_scale is not None else 0.001,
    )


def _copy_others(folder: Path, root: Path, plan: ImportPlan) -> None:
    """Copy models and the like; they are read where they are used, by readers that trust nothing."""
    for target, original in plan.files.items():
        data = read_regular_file(root / original, MAX_OTHER_FILE, ImportRefusedError)
        path = folder / target
        if path.exists():
            raise ImportRefusedError(f"{target}: has the name of one of the recording's own files.")
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)


def _write_json(path: Path, document: object) -> None:
    path.write_text(json.dumps(document, indent=1, ensure_ascii=False, allow_nan=False) + "\n", encoding="utf-8")
