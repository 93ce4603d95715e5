"""Any folder of depth images, with colour images of the same numbers or without."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.image_files import ImageFiles
from tracker.capture.image_series import choose_color, choose_depth, look_at
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera, default_name
from tracker.capture.import_question import ImportQuestion, make_question
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
        problems: list[str] = []
        warnings: list[str] = []
        questions: list[ImportQuestion] = []
        depth = choose_depth(files, options, problems, questions)
        color = choose_color(files, options, depth, problems, questions)
        gaps = _describe_gaps(depth, problems, warnings, questions, allow=bool(options.allow_gaps))
        used = {*depth.names, *(color.names if color else ())}
        ignored = [name for name in files.names if name not in used]
        if ignored and not any(question.is_required and question.choices for question in questions):
            shown = ", ".join(ignored[:3]) + (", ..." if len(ignored) > 3 else "")
            warnings.append(f"{say_count(len(ignored), 'other file is', 'other files are')} left out: {shown}.")
        stream = ImageFiles(files.root, depth.names, True)
        header = look_at(files, depth)
        size = (header.width, header.height) if header is not None else None
        try:
            raw = stream.sample_depth().percentiles if options.preset else ()
            options = apply_preset(options, size, raw, warnings)
        except ImportRefusedError as fault:
            problems.append(str(fault))
            questions.append(make_question("preset", str(fault), str(fault)))
        camera = PlannedCamera(
            id="cam0",
            K=read_intrinsics(options, problems, questions),
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
            problems=tuple(problems),
            warnings=tuple(warnings),
            questions=tuple(questions),
            takes=TAKES,
        )


def read_intrinsics(
    options: ImportOptions, problems: list[str], questions: list[ImportQuestion]
) -> npt.NDArray[np.float64] | None:
    """K (3, 3) px of the options; what is missing goes to the problems and the questions."""
    missing = [name for name in ("fx", "cx", "cy") if getattr(options, name) is None]
    if missing:
        text = f"The camera is not known: give {', '.join(missing)} (and fy if it differs from fx), in px."
        problems.append(text)
        ask = "In pixels of this image size: from the camera's calibration, or a typical value of its kind."
        questions += [make_question(name, ask, text) for name in missing]
        if options.fy is None:
            questions.append(make_question("fy", "As fx when left empty."))
        return None
    assert options.fx is not None and options.cx is not None and options.cy is not None
    return np.array([[options.fx, 0, options.cx], [0, options.fy or options.fx, options.cy], [0, 0, 1]], np.float64)


def _describe_gaps(
    series: NumberedFiles,
    problems: list[str],
    warnings: list[str],
    questions: list[ImportQuestion],
    *,
    allow: bool,
) -> list[str]:
    """Sentences about numbers that are missing; a reason to refuse unless gaps are allowed."""
    if series.doubles:
        problems.append(f"Two files have the same number: {', '.join(series.doubles[:5])}.")
    if series.step > 1:
        warnings.append(
            f"{series.pattern} is numbered in steps of {series.step}; the frames become 0, 1, 2, ... "
            "Give the frame rate of these frames, not of the camera."
        )
    gaps = series.find_gaps()
    sentences = [f"{count} missing between {a} and {b}" for a, b, count in gaps]
    if gaps:
        total = sum(count for _, _, count in gaps)
        shown = "; ".join(sentences[:5]) + ("; ..." if len(sentences) > 5 else "")
        text = f"{series.pattern}: {say_count(total, 'frame is', 'frames are')} missing in the numbering ({shown})."
        if allow:
            warnings.append(text + " The frames around them become neighbours.")
        else:
            problems.append(text + " Add them, or allow gaps.")
            ask = f"{text} If they are imported all the same, the frames around a gap become neighbours."
            questions.append(make_question("allow_gaps", ask, problems[-1]))
    return sentences
