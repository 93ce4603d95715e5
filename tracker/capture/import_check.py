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
from tracker.capture.import_findings import Findings, show_first
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import Importer, ImportPlan, PlannedCamera, StreamProbe
from tracker.capture.import_question import ImportChoice, merge_questions
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

_HANDS = (
    ImportChoice(["right"], "Right hand"),
    ImportChoice(["left"], "Left hand"),
    ImportChoice(["right", "left"], "Both hands"),
)

SAMPLES = 12
"""Frames of each stream that are decoded before an import is offered."""
DEFAULT_FPS = 30.0
"""Proposed where nothing says it: most depth cameras record so."""


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
        plan = _make_plan(files, format, options)
    except (TrackerError, OSError) as fault:
        text = str(fault) if isinstance(fault, TrackerError) else f"Cannot be read: {fault}."
        return CheckedImport(None, ImportReport(format or "", name, problems=(text,), options=told), {}, {}, source)
    found = Findings(list(plan.problems), list(plan.warnings), list(plan.questions))
    _check_folder(files, plan, options, found)
    measured = tuple(ObjectReport(item.name) for item in plan.objects)
    if measure is not None:
        objects = ObjectCheck(found)
        plan, measured = objects.check(plan, files.root, options, measure)
        plan = replace(plan, takes=(*plan.takes, *objects.takes))
    probes = {camera.id: _probe(camera, found, known) for camera in plan.cameras}
    frame_count = _agree_on_count(plan, probes, options, found)
    fps = _agree_on_fps(plan, probes, found)
    times = {camera.id: _find_times(camera, probes[camera.id]) for camera in plan.cameras}
    cameras = tuple(report_camera(camera, probes[camera.id], times[camera.id], found) for camera in plan.cameras)
    sizes = {camera.id: (camera.width, camera.height) for camera in cameras}
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
        baselines_m=_find_baselines(plan, found),
        problems=tuple(dict.fromkeys(found.problems)),
        warnings=tuple(dict.fromkeys(found.warnings)),
        left_out=(*plan.left_out, *_find_cut(plan, probes, frame_count)),
        options=told,
        questions=merge_questions((item for item in found.questions if item.field in plan.takes), sensors),
        sensors=sensors,
        takes=plan.takes,
    )
    return CheckedImport(replace(plan, fps=fps), report, sizes, times, files.root)


def _make_plan(files: ListedFiles, format: str | None, options: ImportOptions) -> ImportPlan:
    plan = _choose_importer(files, format).plan(files, options)
    shifts = parse_shifts(options.camera_shifts or "")
    return shift_plan(plan, shifts) if shifts else plan


def _check_folder(files: ListedFiles, plan: ImportPlan, options: ImportOptions, found: Findings) -> None:
    """Names that were left out for safety, and hands that nobody told."""
    if files.refused:
        are = say_count(len(files.refused), "name in the folder is", "names in the folder are")
        found.refuse(f"{are} not safe: {show_first(files.refused, 5, '; ')}.")
    if options.hands is None and plan.format != OWN_FORMAT:
        found.warn("Which hands the recording shows was not given; a right hand is assumed.")
        found.ask("hands", "A right hand is assumed.", choices=_HANDS)


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


def _fit_sensors(
    plan: ImportPlan, probes: dict[str, dict[str, StreamProbe]], sizes: dict[str, tuple[int, int]]
) -> tuple[SensorFit, ...]:
    """Typical depth cameras with images of this size; none where the files say which camera it was."""
    if "preset" not in plan.takes or not plan.cameras:
        return ()
    camera = plan.cameras[0].id
    size, sample = sizes[camera], probes[camera]["depth"].depth
    return fit_presets(size if size != (0, 0) else None, sample.percentiles if sample else ())


def _probe(camera: PlannedCamera, found: Findings, known: dict[Hashable, StreamProbe] | None) -> dict[str, StreamProbe]:
    probes = {}
    for kind, stream in camera.streams():
        try:
            probe = None if known is None else known.get(stream)
            probes[kind] = stream.probe(SAMPLES) if probe is None else probe
            if known is not None:
                known[stream] = probes[kind]
        except (TrackerError, OSError) as fault:
            probes[kind] = StreamProbe(0, None, {}, (str(fault),))
        found.problems += probes[kind].problems
    return probes


def _find_times(camera: PlannedCamera, probes: dict[str, StreamProbe]) -> npt.NDArray[np.float64]:
    """(T,) s, as the source tells them or as the video holds them; empty when neither does."""
    if camera.timestamps.size:
        return camera.timestamps
    return next((probe.timestamps for probe in probes.values() if probe.timestamps.size), np.zeros(0))


def _agree_on_count(
    plan: ImportPlan, probes: dict[str, dict[str, StreamProbe]], options: ImportOptions, found: Findings
) -> int:
    """Frames that all streams have."""
    counts = {f"{camera} {kind}": p.count for camera, own in probes.items() for kind, p in own.items()}
    fewest, most = min(counts.values(), default=0), max(counts.values(), default=0)
    if fewest == 0 or most > MAX_FRAMES:
        found.refuse(f"{say_count(fewest if fewest == 0 else most, 'frame')}; a recording has 1 to {MAX_FRAMES}.")
    elif fewest != most:
        found.miss(
            f"Frame counts differ: {', '.join(f'{name} {count}' for name, count in counts.items())}.",
            options.allow_gaps,
            allowed=f"Only the first {fewest} are imported; check that frame 0 is the same moment in all.",
            refused="Frames are missing, or the cameras did not start together; allow gaps to cut all.",
            ask=f"All can be cut to the first {fewest}, if frame 0 is the same moment in all.",
        )
    if plan.frame_count is not None and fewest and plan.frame_count != fewest:
        declared = say_count(plan.frame_count, "frame is", "frames are")
        found.refuse(f"{declared} declared and {fewest} {'is' if fewest == 1 else 'are'} there.")
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


def _agree_on_fps(plan: ImportPlan, probes: dict[str, dict[str, StreamProbe]], found: Findings) -> float:
    """Frame rate that was told, or that of the timestamps, or that of the videos, or 30."""
    said = {f"{c} {kind}": p.fps for c, own in probes.items() for kind, p in own.items() if p.fps}
    rates = list(said.values())
    if rates and max(rates) > 1.005 * min(rates):
        text = f"Frame rates differ: {', '.join(f'{name} {rate:g}' for name, rate in said.items())}."
        if plan.fps:
            found.warn(text)
        else:
            ask = f"{text} Give the rate if the cameras ran together."
            found.refuse(f"{text} Give fps if they ran together.", "fps", ask)
    if plan.fps:
        return plan.fps
    for camera in plan.cameras:
        if len(camera.timestamps) > 1:
            return float(round(1 / np.median(np.diff(camera.timestamps)), 3))
    if rates:
        return float(np.median(rates))
    found.warn(f"The frame rate is not known; {DEFAULT_FPS:g} frames per second are assumed.")
    found.ask("fps", f"{DEFAULT_FPS:g} are assumed.")
    return DEFAULT_FPS


def _find_baselines(plan: ImportPlan, found: Findings) -> dict[str, float]:
    baselines = {}
    if not plan.unit_known:
        return baselines
    for a, b in combinations(plan.cameras, 2):
        length = float(np.linalg.norm(a.T_world_camera[:3, 3] - b.T_world_camera[:3, 3]))
        baselines[f"{a.id} - {b.id}"] = length
        if length < 0.005:
            found.warn(f"{a.id} and {b.id} are {length * 1000:.1f} mm apart; is the calibration's unit right?")
        elif length > 20:
            found.warn(f"{a.id} and {b.id} are {length:.1f} m apart; is the calibration's unit right?")
    return baselines
