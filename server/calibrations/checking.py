"""What is wrong with films and options, all of it at once, before a job looks for the board in every frame."""

from __future__ import annotations

from pathlib import Path

from server.calibrations.schemas import CalibrationOptions, FilmedCamera, FilmReport
from tracker import TrackerError
from tracker.calibration import SourceCheck, check_sources, list_films, load_lenses


def check_films(folder: Path, options: CalibrationOptions) -> FilmReport:
    """Look at the header and the first picture of every camera, at the lenses and at the board."""
    films = list_films(folder)
    problems = list(films.faults)
    board, lenses = "", None
    try:
        board = options.board.make_board().describe()
    except TrackerError as fault:
        problems.append(str(fault))
    if films.lenses is not None:
        try:
            lenses = load_lenses(films.lenses)
        except TrackerError as fault:
            problems.append(f"The known lenses: {fault}")
    checked = check_sources(films.cameras, options.fps, options.find_offsets, lenses)
    problems += checked.faults
    notes = _find_notes(checked, options)
    if films.left_out:
        notes.append(f"Left out, being neither a video nor a folder of images: {', '.join(films.left_out[:5])}.")
    return FilmReport(
        board=board,
        cameras=_describe(checked),
        lenses=[] if lenses is None else list(lenses),
        problems=[_hide(problem, folder) for problem in problems],
        notes=notes,
    )


def _describe(checked: SourceCheck) -> list[FilmedCamera]:
    return [
        FilmedCamera(
            name=source.id,
            kind="images" if source.images else "video",
            frames=source.promised,
            fps=source.fps,
            width=width,
            height=height,
        )
        for source, (width, height) in zip(checked.sources, checked.sizes, strict=True)
    ]


def _find_notes(checked: SourceCheck, options: CalibrationOptions) -> list[str]:
    timeless = [source.id for source in checked.sources if source.images and not source.fps]
    if timeless and options.find_offsets:
        return [
            f"{', '.join(timeless[:4])}: images without a frame rate tell no time offset; frames of one number are "
            "taken as one moment. Say the frames a second to have offsets looked for."
        ]
    return []


def _hide(text: str, folder: Path) -> str:
    """A sentence without the place where the studio keeps the films."""
    return text.replace(f"{folder}/", "").replace(str(folder), "the upload")
