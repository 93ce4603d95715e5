"""Our own format: a folder with `sequence.json`."""

from __future__ import annotations

from pathlib import PurePosixPath

from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.frame_pattern import FramePattern
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera
from tracker.capture.listed_files import ListedFiles
from tracker.capture.sequence import SEQUENCE_FILE, TRUTH_FILE, Sequence, load_sequence
from tracker.capture.video_file import VideoFile
from tracker.errors import TrackerError


class RecordingFolder:
    """Importer of recording folders as DESIGN describes them; nothing may be missing in them."""

    format = "recording_folder"
    turn = 1

    def recognises(self, files: ListedFiles) -> bool:
        return SEQUENCE_FILE in files.names

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        sequence = load_sequence(files.root)
        used: set[str] = {SEQUENCE_FILE, "sources.json", "import_report.json"}
        found = Findings()
        models = [name for item in sequence.objects for name in find_model_files(files, item.model)]
        copies = {name: name for name in (TRUTH_FILE, *models) if name in files.names}
        _check_whole(files, sequence, found)
        annotations = _load_annotations(sequence, found)
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
        used |= {*copies, sequence.annotations or ""}
        unnamed = "that sequence.json does not name"
        found.leave_out([n for n in files.names if n not in used], f"file {unnamed} is", f"files {unnamed} are")
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
            problems=tuple(found.problems),
            warnings=tuple(found.warnings),
        )


def _check_whole(files: ListedFiles, sequence: Sequence, found: Findings) -> None:
    """Every model and every film that the recording names has to be there; frames are looked at later."""
    for item in sequence.objects:
        if item.model not in files.names:
            found.refuse(f"{item.model}: the model of object {item.name!r} is missing.")
    for camera in sequence.cameras:
        if camera.film is not None and camera.film not in files.names:
            found.refuse(f"{camera.film}: the film of camera {camera.id} is missing.")


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


def _load_annotations(sequence: Sequence, found: Findings) -> Annotations | None:
    """Annotations of the recording; none when something is wrong with them, which goes to the findings."""
    try:
        path = sequence.annotations_path
        if path is None or not path.exists():
            return None
        annotations = load_annotations(path)
    except TrackerError as fault:
        return found.refuse(str(fault))
    known = {camera.id for camera in sequence.cameras}
    for item in annotations.items:
        if item.camera not in known or item.frame >= sequence.frame_count:
            return found.refuse(f"{path}: frame {item.frame} of camera {item.camera!r} is not in the recording.")
    return annotations
