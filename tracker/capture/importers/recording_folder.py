"""Our own format: a folder with `sequence.json`."""

from __future__ import annotations

from pathlib import PurePosixPath

from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.frame_pattern import FramePattern
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera
from tracker.capture.listed_files import ListedFiles
from tracker.capture.sequence import SEQUENCE_FILE, Sequence, load_sequence
from tracker.capture.video_file import VideoFile
from tracker.errors import AnnotationError, TrackerError, say_count

TRUTH_FILE = "truth.npz"
"""What is exactly known of a synthetic recording."""

_WRITTEN_BY_IMPORTS = ("sources.json", "import_report.json")


class RecordingFolder:
    """Importer of recording folders as DESIGN describes them; nothing may be missing in them."""

    format = "recording_folder"
    turn = 1

    def recognises(self, files: ListedFiles) -> bool:
        return SEQUENCE_FILE in files.names

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        sequence = load_sequence(files.root)
        used: set[str] = {SEQUENCE_FILE, *_WRITTEN_BY_IMPORTS}
        problems: list[str] = []
        copies = {name: name for name in (TRUTH_FILE,) if name in files.names}
        for item in sequence.objects:
            beside = find_model_files(files, item.model)
            if item.model not in beside:
                problems.append(f"{item.model}: the model of object {item.name!r} is missing.")
            copies |= {name: name for name in beside}
        problems += [
            f"{camera.film}: the film of camera {camera.id} is missing."
            for camera in sequence.cameras
            if camera.film is not None and camera.film not in files.names
        ]
        annotations, faults = _load_annotations(sequence)
        cameras = tuple(
            PlannedCamera(
                id=camera.id,
                K=camera.K,
                distortion=camera.distortion,
                T_world_camera=camera.T_world_camera,
                color=_find_film(files, camera.film, options, used)
                or _list_frames(files, camera.color, sequence.frame_count, False, used),
                depth=_list_frames(files, camera.depth, sequence.frame_count, True, used),
                depth_scale=camera.depth_scale if camera.depth else None,
                calibrated_size=(camera.width, camera.height),
            )
            for camera in sequence.cameras
        )
        others = [n for n in files.names if n not in used | set(copies) | {sequence.annotations or ""}]
        warnings = []
        if others:
            shown = ", ".join(others[:3]) + (", ..." if len(others) > 3 else "")
            are = say_count(
                len(others), "file that sequence.json does not name is", "files that sequence.json does not name are"
            )
            warnings.append(f"{are} left out: {shown}.")
        return ImportPlan(
            format=self.format,
            name=options.name or sequence.name,
            fps=options.fps or sequence.fps,
            cameras=cameras,
            frame_count=sequence.frame_count,
            hands=options.hands if options.hands is not None else sequence.hands,
            objects=sequence.objects,
            gravity=sequence.gravity,
            planes=sequence.planes,
            files=copies,
            annotations=annotations,
            problems=(*problems, *faults),
            warnings=tuple(warnings),
        )


def find_model_files(files: ListedFiles, model: str) -> list[str]:
    """A model file and those of the same name beside it (`.OFF` comes with `.SKEL`, `.SKIN`, ...)."""
    path = PurePosixPath(model)
    folder = "" if str(path.parent) == "." else f"{path.parent}/"
    return [n for n in files.names if n == model or (n.rpartition(".")[0] == f"{folder}{path.stem}")]


def _list_frames(
    files: ListedFiles, pattern: FramePattern | None, count: int, is_depth: bool, used: set[str]
) -> ImageFiles | None:
    if pattern is None:
        return None
    names = tuple(pattern.path(index) for index in range(count))
    used.update(names)
    return ImageFiles(files.root, names, is_depth)


def _find_film(files: ListedFiles, film: str | None, options: ImportOptions, used: set[str]) -> VideoFile | None:
    if film is None or film not in files.names:
        return None
    used.add(film)
    return VideoFile(files.root, film, options.color_format == "png")


def _load_annotations(sequence: Sequence) -> tuple[Annotations | None, list[str]]:
    """Annotations of the recording, and what is wrong with them."""
    try:
        path = sequence.annotations_path
        if path is None or not path.exists():
            return None, []
        annotations = load_annotations(path)
    except TrackerError as fault:
        return None, [str(fault)]
    known = {camera.id for camera in sequence.cameras}
    for item in annotations.items:
        if item.camera not in known or item.frame >= sequence.frame_count:
            fault = AnnotationError(f"{path}: frame {item.frame} of camera {item.camera!r} is not in the recording.")
            return None, [str(fault)]
    return annotations, []
