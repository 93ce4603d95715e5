"""Look at a recording before anything of it is stored."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace
from itertools import combinations
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.camera_check import report_camera
from tracker.capture.camera_shifts import shift_plan
from tracker.capture.frame_shifts import parse_shifts
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import Importer, ImportPlan, PlannedCamera, StreamProbe
from tracker.capture.import_question import ImportChoice, ImportQuestion, make_question, merge_questions
from tracker.capture.import_report import ImportReport
from tracker.capture.importers import IMPORT_FORMATS, list_importers
from tracker.capture.listed_files import ListedFiles, list_files
from tracker.capture.object_units import MeasureMesh, ObjectCheck, ObjectReport
from tracker.capture.sensor_presets import SensorFit, fit_presets
from tracker.capture.sequence import MAX_FRAMES
from tracker.errors import ImportRefusedError, TrackerError, say_count

_LABEL_FILES = {"_xyz.json": "FreiHAND", "_joint_3d.json": "InterHand2.6M", "person_keypoints.json": "COCO"}
"""Ends of names that tell a set of labels from a recording."""

OWN_FORMAT = "recording_folder"
"""Its `sequence.json` tells which hands are seen."""

SAMPLES = 12
DEFAULT_FPS = 30.0


@dataclass(frozen=True, eq=False)
class CheckedImport:
    """A plan with what the look at its files gave.

    Attributes:
        plan: None when nothing can be imported at all.
        report: The report.
        sizes: (width, height) px of each camera.
        times: (T,) s of each camera, or empty.
        root: Folder that the plan's names belong to.
    """

    plan: ImportPlan | None
    report: ImportReport
    sizes: dict[str, tuple[int, int]]
    times: dict[str, npt.NDArray[np.float64]]
    root: Path


def check_import(
    source: Path | str,
    format: str | None = None,
    options: ImportOptions | None = None,
    probes: dict[Hashable, StreamProbe] | None = None,
    measure: MeasureMesh | None = None,
) -> ImportReport:
    """What an import of a folder (or a single video) would bring, and whether it is possible. Stores nothing.

    Args:
        source: Folder of the recording.
        format: One of IMPORT_FORMATS, or None to recognise it.
        options: What the files do not tell.
        probes: What earlier looks at the same files gave, which is used again and added to; the files must not have
            changed meanwhile.
        measure: Tells the size of objects' meshes; without it their unit is not asked for.
    """
    return examine(Path(source), format, options or ImportOptions(), probes, measure).report


def examine(
    source: Path,
    format: str | None,
    options: ImportOptions,
    known: dict[Hashable, StreamProbe] | None = None,
    measure: MeasureMesh | None = None,
) -> CheckedImport:
    """Plan an import and look at every file's header and some pixels."""
    name = options.name or ""
    told = options.to_json() | ({"format": format} if format else {})
    try:
        files = list_files(source)
        importer = _choose_importer(files, format)
        plan = importer.plan(files, options)
        if shifts := parse_shifts(options.camera_shifts or ""):
            plan = shift_plan(plan, shifts)
    except (TrackerError, OSError) as fault:
        text = str(fault) if isinstance(fault, TrackerError) else f"Cannot be read: {fault}."
        return CheckedImport(None, ImportReport(format or "", name, problems=(text,), options=told), {}, {}, source)
    problems, warnings, questions = list(plan.problems), list(plan.warnings), list(plan.questions)
    if files.refused:
        shown = "; ".join(files.refused[:5]) + ("; ..." if len(files.refused) > 5 else "")
        are = say_count(len(files.refused), "name in the folder is", "names in the folder are")
        problems.append(f"{are} not safe: {shown}.")
    if options.hands is None and plan.format != OWN_FORMAT:
        warnings.append("Which hands the recording shows was not given; a right hand is assumed.")
        questions.append(_ask_hands())
    objects, measured = ObjectCheck(problems, warnings, questions), tuple(ObjectReport(o.name) for o in plan.objects)
    if measure is not None:
        plan, measured = objects.check(plan, files.root, options, measure)
        plan = replace(plan, takes=(*plan.takes, *objects.takes))
    probes = {camera.id: _probe(camera, problems, known) for camera in plan.cameras}
    frame_count = _agree_on_count(plan, probes, problems, warnings, questions, allow=bool(options.allow_gaps))
    fps = _agree_on_fps(plan, probes, problems, warnings, questions)
    sizes: dict[str, tuple[int, int]] = {}
    times = {camera.id: _find_times(camera, probes[camera.id]) for camera in plan.cameras}
    cameras = tuple(
        report_camera(c, probes[c.id], times[c.id], sizes, problems, warnings, questions) for c in plan.cameras
    )
    sensors = _fit_sensors(plan, probes, sizes)
    report = ImportReport(
        format=plan.format,
        name=plan.name,
        fps=fps,
        frame_count=frame_count,
        cameras=cameras,
        hands=plan.hands,
        objects=tuple(item.name for item in plan.objects),
        object_sizes=measured,
        annotations=len(plan.annotations.items) if plan.annotations else 0,
        baselines_m=_find_baselines(plan, problems, warnings),
        problems=tuple(dict.fromkeys(problems)),
        warnings=tuple(dict.fromkeys(warnings)),
        left_out=(*plan.left_out, *_find_cut(plan, probes, frame_count)),
        options=told,
        questions=merge_questions((item for item in questions if item.field in plan.takes), sensors),
        sensors=sensors,
        takes=plan.takes,
    )
    return CheckedImport(replace(plan, fps=fps), report, sizes, times, files.root)


def _choose_importer(files: ListedFiles, format: str | None) -> Importer:
    known = ", ".join(IMPORT_FORMATS)
    for importer in list_importers():
        if format == importer.format or (format is None and importer.recognises(files)):
            return importer
    if format is not None:
        raise ImportRefusedError(f"Format {format!r} is not known; known: {known}.")
    kinds = sorted({name.rpartition(".")[2].lower()[:10] for name in files.names})[:8]
    found = f"{say_count(len(files.names), 'file')} ({', '.join(kinds)})" if files.names else "no files"
    if labels := next((title for end, title in _LABEL_FILES.items() if any(n.endswith(end) for n in files.names)), ""):
        raise ImportRefusedError(
            f"These {len(files.names)} files are labels in the form of {labels}, not a recording. Needed a recording's "
            "images; import labels on the page Labels of the recording they belong to."
        )
    raise ImportRefusedError(
        f"No recording is recognised: found {found}; needed sequence.json, numbered depth PNGs, "
        "rgb.txt with depth.txt, or videos with a calibration."
    )


def _ask_hands() -> ImportQuestion:
    choices = (
        ImportChoice(["right"], "Right hand"),
        ImportChoice(["left"], "Left hand"),
        ImportChoice(["right", "left"], "Both hands"),
    )
    return make_question("hands", "A right hand is assumed.", choices=choices)


def _fit_sensors(
    plan: ImportPlan, probes: dict[str, dict[str, StreamProbe]], sizes: dict[str, tuple[int, int]]
) -> tuple[SensorFit, ...]:
    """Typical depth cameras with images of this size; none where the files say which camera it was."""
    if "preset" not in plan.takes or not plan.cameras:
        return ()
    camera = plan.cameras[0].id
    size, sample = sizes[camera], probes[camera]["depth"].depth
    return fit_presets(size if size != (0, 0) else None, sample.percentiles if sample else ())


def _probe(
    camera: PlannedCamera, problems: list[str], known: dict[Hashable, StreamProbe] | None
) -> dict[str, StreamProbe]:
    probes = {}
    for kind, stream in camera.streams():
        try:
            probe = None if known is None else known.get(stream)
            probes[kind] = stream.probe(SAMPLES) if probe is None else probe
            if known is not None:
                known[stream] = probes[kind]
        except (TrackerError, OSError) as fault:
            probes[kind] = StreamProbe(0, None, {}, (str(fault),))
        problems += probes[kind].problems
    return probes


def _find_times(camera: PlannedCamera, probes: dict[str, StreamProbe]) -> npt.NDArray[np.float64]:
    """(T,) s, as the source tells them or as the video holds them; empty when neither does."""
    if camera.timestamps.size:
        return camera.timestamps
    return next((probe.timestamps for probe in probes.values() if probe.timestamps.size), np.zeros(0))


def _agree_on_count(
    plan: ImportPlan,
    probes: dict[str, dict[str, StreamProbe]],
    problems: list[str],
    warnings: list[str],
    questions: list[ImportQuestion],
    *,
    allow: bool,
) -> int:
    """Frames that all streams have."""
    counts = {f"{camera} {kind}": p.count for camera, own in probes.items() for kind, p in own.items()}
    fewest, most = min(counts.values(), default=0), max(counts.values(), default=0)
    if fewest == 0 or most > MAX_FRAMES:
        problems.append(f"{say_count(fewest if fewest == 0 else most, 'frame')}; a recording has 1 to {MAX_FRAMES}.")
    elif fewest != most:
        text = f"Frame counts differ: {', '.join(f'{name} {count}' for name, count in counts.items())}."
        if allow:
            warnings.append(
                f"{text} Only the first {fewest} are imported; check that frame 0 is the same moment in all."
            )
        else:
            problems.append(f"{text} Frames are missing, or the cameras did not start together; allow gaps to cut all.")
            ask = f"{text} All can be cut to the first {fewest}, if frame 0 is the same moment in all."
            questions.append(make_question("allow_gaps", ask, problems[-1]))
    if plan.frame_count is not None and fewest and plan.frame_count != fewest:
        declared = say_count(plan.frame_count, "frame is", "frames are")
        problems.append(f"{declared} declared and {fewest} {'is' if fewest == 1 else 'are'} there.")
    return fewest


def _find_cut(plan: ImportPlan, probes: dict[str, dict[str, StreamProbe]], frame_count: int) -> list[str]:
    """Names of the frames that some streams have beyond the last common one."""
    if frame_count == 0:
        return []
    return [
        stream.name_of(index)
        for camera in plan.cameras
        for kind, stream in camera.streams()
        for index in range(frame_count, probes[camera.id][kind].count)
    ]


def _agree_on_fps(
    plan: ImportPlan,
    probes: dict[str, dict[str, StreamProbe]],
    problems: list[str],
    warnings: list[str],
    questions: list[ImportQuestion],
) -> float:
    """Frame rate that was told, or that of the timestamps, or that of the videos, or 30."""
    said = {f"{c} {kind}": p.fps for c, own in probes.items() for kind, p in own.items() if p.fps}
    rates = list(said.values())
    if rates and max(rates) > 1.005 * min(rates):
        text = f"Frame rates differ: {', '.join(f'{name} {rate:g}' for name, rate in said.items())}."
        (warnings if plan.fps else problems).append(text + ("" if plan.fps else " Give fps if they ran together."))
        if not plan.fps:
            questions.append(make_question("fps", f"{text} Give the rate if the cameras ran together.", problems[-1]))
    if plan.fps:
        return plan.fps
    for camera in plan.cameras:
        if len(camera.timestamps) > 1:
            return float(round(1 / np.median(np.diff(camera.timestamps)), 3))
    if rates:
        return float(np.median(rates))
    warnings.append(f"The frame rate is not known; {DEFAULT_FPS:g} frames per second are assumed.")
    questions.append(make_question("fps", f"{DEFAULT_FPS:g} are assumed."))
    return DEFAULT_FPS


def _find_baselines(plan: ImportPlan, problems: list[str], warnings: list[str]) -> dict[str, float]:
    baselines = {}
    if not plan.unit_known:
        return baselines
    for a, b in combinations(plan.cameras, 2):
        length = float(np.linalg.norm(a.T_world_camera[:3, 3] - b.T_world_camera[:3, 3]))
        baselines[f"{a.id} - {b.id}"] = length
        if length < 0.005:
            warnings.append(f"{a.id} and {b.id} are {length * 1000:.1f} mm apart; is the calibration's unit right?")
        elif length > 20:
            warnings.append(f"{a.id} and {b.id} are {length:.1f} m apart; is the calibration's unit right?")
    return baselines
