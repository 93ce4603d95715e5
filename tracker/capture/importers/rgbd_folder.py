"""Any folder of depth images, with colour images of the same numbers or without."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.image_files import ImageFiles
from tracker.capture.image_series import choose_color, choose_depth, look_at
from tracker.capture.import_findings import Findings, show_first
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera, default_name
from tracker.capture.import_question import make_question
from tracker.capture.listed_files import ListedFiles
from tracker.capture.numbered_files import NumberedFiles
from tracker.capture.sensor_presets import apply_preset
from tracker.errors import ImportRefusedError, say_count

TAKES = (
    *("preset", "fx", "fy", "cx", "cy", "depth_scale", "fps", "hands", "allow_gaps"),
    *("depth_pattern", "color_pattern", "distortion"),
)


class RgbdFolder:
    """Importer of numbered depth PNGs; the intrinsics come by options."""

    format = "rgbd_folder"
    turn = 9

    def recognises(self, files: ListedFiles) -> bool:
        return any(name.lower().endswith(".png") for name in files.names)

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        found = Findings()
        depth = choose_depth(files, options, found)
        color = choose_color(files, options, depth, found)
        gaps = _describe_gaps(depth, options, found)
        used = {*depth.names, *(color.names if color else ())}
        if not any(question.is_required and question.choices for question in found.questions):
            found.leave_out([name for name in files.names if name not in used])
        stream = ImageFiles(files.root, depth.names, True)
        header = look_at(files, depth)
        size = (header.width, header.height) if header is not None else None
        try:
            raw = stream.sample_depth().percentiles if options.preset else ()
            options = apply_preset(options, size, raw, found.warnings)
        except ImportRefusedError as fault:
            found.refuse(str(fault), "preset")
        camera = PlannedCamera(
            id="cam0",
            K=read_intrinsics(options, found),
            distortion=np.array(options.distortion or (), dtype=np.float64),
            color=ImageFiles(files.root, color.names, False) if color else None,
            depth=stream,
            depth_scale=options.depth_scale,
            gaps=tuple(gaps),
        )
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
        )


def read_intrinsics(options: ImportOptions, found: Findings) -> npt.NDArray[np.float64] | None:
    """K (3, 3) px of the options; what is missing goes to the findings."""
    missing = [name for name in ("fx", "cx", "cy") if getattr(options, name) is None]
    if missing:
        text = f"The camera is not known: give {', '.join(missing)} (and fy if it differs from fx), in px."
        found.problems.append(text)
        ask = "In pixels of this image size: from the camera's calibration, or a typical value of its kind."
        found.questions += [make_question(name, ask, text) for name in missing]
        if options.fy is None:
            found.ask("fy", "As fx when left empty.")
        return None
    assert options.fx is not None and options.cx is not None and options.cy is not None
    return np.array([[options.fx, 0, options.cx], [0, options.fy or options.fx, options.cy], [0, 0, 1]], np.float64)


def _describe_gaps(series: NumberedFiles, options: ImportOptions, found: Findings) -> list[str]:
    """Sentences about numbers that are missing; a reason to refuse unless gaps are allowed."""
    if series.doubles:
        found.refuse(f"Two files have the same number: {', '.join(series.doubles[:5])}.")
    if series.step > 1:
        found.warn(
            f"{series.pattern} is numbered in steps of {series.step}; the frames become 0, 1, 2, ... "
            "Give the frame rate of these frames, not of the camera."
        )
    gaps = series.find_gaps()
    sentences = [f"{count} missing between {a} and {b}" for a, b, count in gaps]
    if gaps:
        total = sum(count for _, _, count in gaps)
        are, shown = say_count(total, "frame is", "frames are"), show_first(sentences, 5, "; ")
        found.miss(
            f"{series.pattern}: {are} missing in the numbering ({shown}).",
            options.allow_gaps,
            allowed="The frames around them become neighbours.",
            refused="Add them, or allow gaps.",
            ask="If they are imported all the same, the frames around a gap become neighbours.",
        )
    return sentences
