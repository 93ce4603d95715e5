"""Any folder of depth images, with colour images of the same numbers or without."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tracker.capture.image_file import COLOR_SUFFIXES, DEPTH_SUFFIXES, ImageHeader, read_header
from tracker.capture.image_files import ImageFiles
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan, PlannedCamera, default_name
from tracker.capture.listed_files import ListedFiles
from tracker.capture.numbered_files import NumberedFiles, group_by_number, match_pattern
from tracker.errors import FrameError, ImportRefusedError

_MOST_SERIES = 200


class RgbdFolder:
    """Importer of numbered depth PNGs; the intrinsics come by options."""

    format = "rgbd_folder"

    def recognises(self, files: ListedFiles) -> bool:
        return any(name.lower().endswith(".png") for name in files.names)

    def plan(self, files: ListedFiles, options: ImportOptions) -> ImportPlan:
        problems: list[str] = []
        warnings: list[str] = []
        depth = _find_depth(files, options)
        color = _find_color(files, options, depth, problems)
        gaps = _describe_gaps(depth, problems, warnings, allow=bool(options.allow_gaps))
        if color is not None and color.numbers != depth.numbers:
            _describe_mismatch(depth, color, problems)
            color = None
        used = {*depth.names, *(color.names if color else ())}
        ignored = [name for name in files.names if name not in used]
        if ignored:
            shown = ", ".join(ignored[:3]) + (", ..." if len(ignored) > 3 else "")
            warnings.append(f"{len(ignored)} other files are left out: {shown}.")
        camera = PlannedCamera(
            id="cam0",
            K=read_intrinsics(options, problems),
            distortion=np.array(options.distortion or (), dtype=np.float64),
            color=ImageFiles(files.root, color.names, False) if color else None,
            depth=ImageFiles(files.root, depth.names, True),
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
        )


def read_intrinsics(options: ImportOptions, problems: list[str]) -> npt.NDArray[np.float64] | None:
    """K (3, 3) px of the options; what is missing goes to the problems."""
    missing = [name for name in ("fx", "cx", "cy") if getattr(options, name) is None]
    if missing:
        problems.append(f"The camera is not known: give {', '.join(missing)} (and fy if it differs from fx), in px.")
        return None
    assert options.fx is not None and options.cx is not None and options.cy is not None
    return np.array([[options.fx, 0, options.cx], [0, options.fy or options.fx, options.cy], [0, 0, 1]], np.float64)


def _look_at(files: ListedFiles, series: NumberedFiles) -> ImageHeader | None:
    """Header of the first readable file of a series."""
    for name in series.names[:10]:
        try:
            with files.path(name).open("rb") as file:
                return read_header(file.read(256 * 1024), name)
        except (FrameError, OSError):
            continue
    return None


def _is_depth(header: ImageHeader | None) -> bool:
    return header is not None and header.kind == "png" and header.bits == 16 and header.channels == 1


def _given(files: ListedFiles, pattern: str, option: str) -> NumberedFiles:
    """The series that a pattern names; an ImportRefusedError if it names none."""
    series = match_pattern(files.names, pattern)
    if series is None:
        raise ImportRefusedError(f"{option} {pattern!r} needs one place for the number, such as depth/depth_*.png.")
    if not series.names:
        found = ", ".join(s.pattern for s in group_by_number(files.names, COLOR_SUFFIXES)[:5]) or "no numbered images"
        raise ImportRefusedError(f"{option} {pattern!r} matches no file; found {found}.")
    return series


def _find_depth(files: ListedFiles, options: ImportOptions) -> NumberedFiles:
    if options.depth_pattern:
        return _given(files, options.depth_pattern, "depth_pattern")
    groups = group_by_number(files.names, DEPTH_SUFFIXES)[:_MOST_SERIES]
    headers = {series.pattern: _look_at(files, series) for series in groups}
    depths = [series for series in groups if _is_depth(headers[series.pattern])]
    if len(depths) == 1:
        return depths[0]
    if depths:
        shown = ", ".join(f"{s.pattern} ({len(s.names)})" for s in depths[:5])
        raise ImportRefusedError(f"Depth images of {len(depths)} kinds: {shown}. Choose one with depth_pattern.")
    named = [s for s in groups if "depth" in s.pattern.lower()] or groups
    if named and (header := headers[named[0].pattern]):
        hint = "; 8 bits cannot hold depth in millimetres" if header.bits == 8 else ""
        raise ImportRefusedError(
            f"No depth images: needed numbered 16-bit grey PNGs, found {named[0].pattern}, each a {header}{hint}."
        )
    raise ImportRefusedError("No depth images: needed numbered 16-bit grey PNGs, such as depth/000000.png.")


def _find_color(
    files: ListedFiles, options: ImportOptions, depth: NumberedFiles, problems: list[str]
) -> NumberedFiles | None:
    if options.color_pattern == "none":
        return None
    if options.color_pattern:
        return _given(files, options.color_pattern, "color_pattern")
    groups = [s for s in group_by_number(files.names, COLOR_SUFFIXES)[:_MOST_SERIES] if s.names != depth.names]
    colors = [s for s in groups if (header := _look_at(files, s)) is not None and header.channels >= 3]
    same = [series for series in colors if series.numbers == depth.numbers]
    candidates = same or colors
    if len(candidates) > 1:
        shown = ", ".join(f"{s.pattern} ({len(s.names)})" for s in candidates[:5])
        problems.append(f"Colour images of {len(candidates)} kinds: {shown}. Choose one with color_pattern, or 'none'.")
        return None
    return candidates[0] if candidates else None


def _describe_gaps(series: NumberedFiles, problems: list[str], warnings: list[str], *, allow: bool) -> list[str]:
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
        are = "frame is" if total == 1 else "frames are"
        text = f"{series.pattern}: {total} {are} missing in the numbering ({shown})."
        if allow:
            warnings.append(text + " The frames around them become neighbours.")
        else:
            problems.append(text + " Add them, or allow gaps.")
    return sentences


def _describe_mismatch(depth: NumberedFiles, color: NumberedFiles, problems: list[str]) -> None:
    alone = sorted(set(depth.numbers) - set(color.numbers))
    extra = sorted(set(color.numbers) - set(depth.numbers))
    problems.append(
        f"Colour and depth do not have the same numbers: {len(alone)} depth images without colour "
        f"({', '.join(map(str, alone[:5])) or 'none'}), {len(extra)} colour images without depth "
        f"({', '.join(map(str, extra[:5])) or 'none'}). Complete them, or set color_pattern to 'none'."
    )
