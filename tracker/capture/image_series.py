"""Which numbered images of a folder are depth, and which are its colour; what is not clear is asked, not guessed."""

from __future__ import annotations

from tracker.capture.camera_check import pick_pictures
from tracker.capture.image_file import COLOR_SUFFIXES, DEPTH_SUFFIXES, ImageHeader, read_header
from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_question import ImportChoice
from tracker.capture.listed_files import ListedFiles
from tracker.capture.numbered_files import NumberedFiles, group_by_number, match_pattern
from tracker.errors import FrameError, ImportRefusedError, say_count

_MOST_SERIES = 200
"""That are looked at in a folder; a bound of ours."""
_MOST_CHOICES = 24
"""That a question offers."""
_ASK_COLOR = "Which colour images belong to the depth images?"


def look_at(files: ListedFiles, series: NumberedFiles) -> ImageHeader | None:
    """Header of the first readable file of a series."""
    for name in series.names[:10]:
        try:
            with files.path(name).open("rb") as file:
                return read_header(file.read(256 * 1024), name)
        except (FrameError, OSError):
            continue
    return None


def choose_depth(files: ListedFiles, options: ImportOptions, found: Findings) -> NumberedFiles:
    """The depth images that were told or are the only ones; of several the likeliest, and a question.

    Raises ImportRefusedError when there are none.
    """
    depths, missing = _list_depths(files)
    told, fault = _match(files, options.depth_pattern, "depth_pattern")
    if told is None and not depths:
        raise ImportRefusedError(fault or missing)
    named = [series for series in depths if "depth" in series.pattern.lower()]
    likeliest = next(iter(named or depths), None)
    if told is None and not fault and len(depths) > 1:
        fault = f"Depth images of {len(depths)} kinds: {_show(depths)}. Choose one with depth_pattern."
    ask = f"The files hold {say_count(len(depths), 'series', 'series')} of 16-bit grey images. Which one is depth?"
    answers = {
        "proposal": likeliest.pattern if likeliest else None,
        "proposed_by": "its name" if named else "it has the most images",
        "choices": tuple(_make_choice(files, series) for series in depths[:_MOST_CHOICES]),
    }
    if fault:
        found.refuse(fault, "depth_pattern", ask, **answers)
    elif len(depths) > 1:
        found.ask("depth_pattern", ask, **answers)
    chosen = told or likeliest
    assert chosen is not None
    return chosen


def choose_color(
    files: ListedFiles, options: ImportOptions, depth: NumberedFiles, found: Findings
) -> NumberedFiles | None:
    """The colour images with the depth images' numbers: those that were told or the only ones; else a question."""
    colors = _list_colors(files, depth)
    choices = (
        *(_make_choice(files, series) for series in colors[:_MOST_CHOICES]),
        ImportChoice("none", "No colour: import depth alone"),
    )
    if options.color_pattern == "none":
        if colors:
            found.ask("color_pattern", _ASK_COLOR, choices=choices)
        return None
    told, fault = _match(files, options.color_pattern, "color_pattern")
    if fault:
        return found.refuse(fault, "color_pattern", choices=choices)
    candidates = [told] if told else [s for s in colors if s.numbers == depth.numbers] or colors
    if len(candidates) > 1:
        text = (
            f"Colour images of {len(candidates)} kinds: {_show(candidates)}. Choose one with color_pattern, or 'none'."
        )
        return found.refuse(text, "color_pattern", _ASK_COLOR, choices=choices)
    if candidates and candidates[0].numbers != depth.numbers:
        text = _describe_mismatch(depth, candidates[0])
        ask = f"{text} Complete the files, or import depth alone."
        return found.refuse(
            f"{text} Complete them, or set color_pattern to 'none'.", "color_pattern", ask, choices=choices
        )
    if told is not None or len(colors) > 1:
        found.ask("color_pattern", _ASK_COLOR, choices=choices)
    return candidates[0] if candidates else None


def _show(several: list[NumberedFiles]) -> str:
    return ", ".join(f"{series.pattern} ({len(series.names)})" for series in several[:5])


def _list_depths(files: ListedFiles) -> tuple[list[NumberedFiles], str]:
    """Series of 16-bit grey PNGs; when there are none, what there is instead."""
    groups = group_by_number(files.names, DEPTH_SUFFIXES)[:_MOST_SERIES]
    headers = {series.pattern: look_at(files, series) for series in groups}
    depths = [series for series in groups if _is_depth(headers[series.pattern])]
    return depths, "" if depths else _describe_missing(groups, headers)


def _list_colors(files: ListedFiles, depth: NumberedFiles) -> list[NumberedFiles]:
    groups = [s for s in group_by_number(files.names, COLOR_SUFFIXES)[:_MOST_SERIES] if s.names != depth.names]
    return [s for s in groups if (header := look_at(files, s)) is not None and header.channels >= 3]


def _is_depth(header: ImageHeader | None) -> bool:
    return header is not None and header.kind == "png" and header.bits == 16 and header.channels == 1


def _make_choice(files: ListedFiles, series: NumberedFiles) -> ImportChoice:
    pictures = pick_pictures(lambda index: series.names[index], len(series.names))
    header = look_at(files, series)
    return ImportChoice(series.pattern, series.pattern, len(series.names), str(header or "unreadable"), pictures)


def _match(files: ListedFiles, pattern: str | None, option: str) -> tuple[NumberedFiles | None, str]:
    """The series that a pattern names, or what is wrong with it; neither where none was told."""
    if not pattern:
        return None, ""
    series = match_pattern(files.names, pattern)
    if series is None:
        return None, f"{option} {pattern!r} needs one place for the number, such as depth/depth_*.png."
    if not series.names:
        found = ", ".join(s.pattern for s in group_by_number(files.names, COLOR_SUFFIXES)[:5]) or "no numbered images"
        return None, f"{option} {pattern!r} matches no file; found {found}."
    return series, ""


def _describe_missing(groups: list[NumberedFiles], headers: dict[str, ImageHeader | None]) -> str:
    named = [s for s in groups if "depth" in s.pattern.lower()] or groups
    if named and (header := headers[named[0].pattern]):
        hint = "; 8 bits cannot hold depth in millimetres" if header.bits == 8 else ""
        return (
            f"No depth images: needed numbered 16-bit grey PNGs, found {named[0].pattern}, each a {header}{hint}. "
            "Export the raw 16-bit depth and import that."
        )
    return "No depth images: needed numbered 16-bit grey PNGs, such as depth/000000.png."


def _describe_mismatch(depth: NumberedFiles, color: NumberedFiles) -> str:
    alone = sorted(set(depth.numbers) - set(color.numbers))
    extra = sorted(set(color.numbers) - set(depth.numbers))
    return (
        "Colour and depth do not have the same numbers: "
        f"{say_count(len(alone), 'depth image')} without colour ({', '.join(map(str, alone[:5])) or 'none'}), "
        f"{say_count(len(extra), 'colour image')} without depth ({', '.join(map(str, extra[:5])) or 'none'})."
    )
