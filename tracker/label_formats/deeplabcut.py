"""DeepLabCut: `labeled-data/<camera>/CollectedData_<scorer>.csv` with the header of multi-animal projects.

Source: DeepLabCut's own files, as its user guide shows them: rows scorer, individuals, bodyparts, coords; then one row
an image; an empty cell is NaN: not labelled. Hands are the individuals `right` and `left`. Pixel centres are whole
numbers (napari's). A `likelihood` marks what a network predicted; that is no label and is refused.
"""

from __future__ import annotations

import csv
import io
import math
from pathlib import PurePosixPath

import numpy as np

from tracker.capture.annotations import Annotation
from tracker.errors import AnnotationError, reading
from tracker.label_formats.image_names import Place
from tracker.label_formats.label_set import (
    ExportedLabels,
    ImportCollector,
    ImportedLabels,
    ImportHints,
    LabelSet,
    Notes,
    count_joints,
    note_flat_visibility,
)
from tracker.label_formats.orders import find_joint
from tracker.label_formats.values import MAX_ENTRIES, MAX_PIXEL
from tracker.model.joints import HAND_JOINTS, SIDES

PIXEL_CENTRE = 0.0
"""Coordinate of the centre of the top-left pixel."""
SCORER = "handloom"
MAX_COLUMNS = 1000
"""Of a table; a bound of ours."""
Column = tuple[str, int, int]
"""Hand, joint, 0 for x and 1 for y."""


def write_deeplabcut(sets: list[LabelSet]) -> ExportedLabels:
    """One table a camera, a row for each image with labels."""
    (only,) = sets
    losses = Notes()
    note_flat_visibility(losses, only.annotations.items, "DeepLabCut")
    files = {}
    columns = [(hand, name, axis) for hand in SIDES for name in HAND_JOINTS for axis in "xy"]
    for camera in only.sequence.cameras:
        own = [item for item in only.annotations.items if item.camera == camera.id]
        if not own:
            continue
        rows: dict[int, dict[str, Annotation]] = {}
        for item in own:
            rows.setdefault(item.frame, {})[item.hand] = item
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        labels = ("scorer", "individuals", "bodyparts", "coords")
        for label, values in zip(labels, ([SCORER] * len(columns), *zip(*columns, strict=True)), strict=True):
            writer.writerow([label, "", "", *values])
        file_names = _name_images(only, camera.id, sorted(rows))
        for frame, hands in sorted(rows.items()):
            cells = [_write_hand(hands.get(hand)) for hand in SIDES]
            writer.writerow(["labeled-data", camera.id, file_names[frame], *cells[0], *cells[1]])
        files[f"labeled-data/{camera.id}/CollectedData_{SCORER}.csv"] = text.getvalue().encode()
    if not files:
        raise AnnotationError("There are no labels to write as a DeepLabCut table; mark some first.")
    items = only.annotations.items
    return ExportedLabels(files, len(items), count_joints(items), losses.sentences())


def _name_images(labels: LabelSet, camera: str, frames: list[int]) -> dict[int, str]:
    """Their original file names, where these tell them apart; else those in the recording."""
    for known in (labels.names.originals, labels.names.stored):
        paths = {frame: known.get((camera, frame)) or labels.names.stored[camera, frame] for frame in frames}
        names = {frame: PurePosixPath(path).name for frame, path in paths.items()}
        found = [labels.names.find(f"{camera}/{name}", camera) for name in names.values()]
        if found == [[(camera, frame)] for frame in names]:
            return names
    raise AnnotationError(
        f"Images of {camera} share their file names, and DeepLabCut tells images apart by nothing else; export the "
        "labels as COCO keypoints instead."
    )


def _write_hand(item: Annotation | None) -> list[str]:
    if item is None:
        return [""] * (2 * len(HAND_JOINTS))
    return [repr(float(value) + PIXEL_CENTRE) if v > 0 else "" for x, y, v in item.points for value in (x, y)]


def read_deeplabcut(files: dict[str, bytes], sets: list[LabelSet], hints: ImportHints) -> ImportedLabels:
    """Tables of labels; each row's image is found by its path."""
    (only,) = sets
    collector = ImportCollector(sets)
    tables = sorted(name for name in files if name.lower().endswith(".csv"))
    if not tables:
        raise AnnotationError(f"Needed a table CollectedData_....csv; found {', '.join(sorted(files)[:5])}.")
    for name in tables:
        _read_table(name, files[name], only, hints, collector)
    collector.warnings.add("DeepLabCut does not say what is occluded; in {n} [table|tables] every joint is visible",
                           count=len(tables))  # fmt: skip
    return collector.finish()


def _read_table(name: str, data: bytes, labels: LabelSet, hints: ImportHints, collector: ImportCollector) -> None:
    with reading(AnnotationError, name, "a table with DeepLabCut's rows scorer, bodyparts and coords"):
        rows = csv.reader(io.StringIO(data.decode("utf-8-sig"), newline=""), strict=True)
        header = [next(rows)]
        while header[-1][0].strip().lower() != "coords":
            if len(header) > 3:
                raise AnnotationError(f"{name}: no row 'coords' among the first four; needed DeepLabCut's header.")
            header.append(next(rows))
        columns, start = _read_header(name, header, labels, hints, collector)
        for number, row in enumerate(rows, len(header) + 1):
            if number > MAX_ENTRIES:
                raise AnnotationError(f"{name}: has more than {MAX_ENTRIES} rows.")
            if row:
                _read_row(f"{name}, line {number}", row, start, columns, labels, hints, collector)


def _read_header(
    name: str, header: list[list[str]], labels: LabelSet, hints: ImportHints, collector: ImportCollector
) -> tuple[dict[int, Column], int]:
    """What each column of labels is, and where they begin."""
    rows = {row[0].strip().lower(): row for row in header}
    coords = _check_header(name, rows, header)
    start = next((i for i, cell in enumerate(coords) if i and cell), len(coords))
    if len(set(rows["scorer"][start:])) > 1:
        raise AnnotationError(f"{name}: holds labels of several scorers; import one scorer at a time.")
    if "individuals" in rows:
        individuals = [cell.strip().lower() for cell in rows["individuals"]]
    else:
        individuals = [_find_only_hand(name, labels, hints, collector)] * len(coords)
    columns: dict[int, Column] = {}
    for i in range(start, len(coords)):
        column = _find_column(individuals[i], rows["bodyparts"][i], coords[i])
        if column is None:
            what = f"{rows['bodyparts'][i]} of {individuals[i]}"[:80]
            collector.warnings.add(
                "{n} [column is|columns are] no joint of the right or left hand and [was|were] left out", what
            )
        elif column in columns.values():
            raise AnnotationError(
                f"{name}: two columns are the {coords[i]} of {rows['bodyparts'][i]} of {individuals[i]}."
            )
        else:
            columns[i] = column
    if not columns:
        raise AnnotationError(
            f"{name}: no column is a joint of a hand. Name body parts like {', '.join(HAND_JOINTS[:3])} ..., "
            "individuals right and left."
        )
    return columns, start


def _check_header(name: str, rows: dict[str, list[str]], header: list[list[str]]) -> list[str]:
    """The cells of the row `coords`."""
    if set(rows) - {"individuals"} != {"scorer", "bodyparts", "coords"} or len({len(row) for row in header}) != 1:
        raise AnnotationError(
            f"{name}: the header has the rows {', '.join(rows)}; needed scorer, (individuals,) bodyparts and coords, "
            "all of one length."
        )
    coords = [cell.strip() for cell in rows["coords"]]
    if len(coords) > MAX_COLUMNS:
        raise AnnotationError(f"{name}: has {len(coords)} columns; at most {MAX_COLUMNS} are read.")
    if "likelihood" in coords:
        raise AnnotationError(
            f"{name}: has a column 'likelihood': it holds predictions of a network, not labels. Only labels "
            "(CollectedData_....csv) are imported."
        )
    return coords


def _find_only_hand(name: str, labels: LabelSet, hints: ImportHints, collector: ImportCollector) -> str:
    """The hand of a table that knows no individuals."""
    if hints.hand:
        return hints.hand
    if len(labels.sequence.hands) != 1:
        raise AnnotationError(
            f"{name}: has no row 'individuals', and both hands are seen in the recording. Say which hand it is "
            "with the option hand (right or left)."
        )
    only = labels.sequence.hands[0]
    collector.warnings.add(f"The table knows one individual, which was taken as the {only} hand")
    return only


def _find_column(who: str, part: str, coord: str) -> Column | None:
    side = next((hand for hand in SIDES if hand in who), None)
    joint = find_joint(part)
    if side is None or joint is None or coord not in ("x", "y"):
        return None
    return side, joint, "xy".index(coord)


def _read_row(
    where: str,
    row: list[str],
    start: int,
    columns: dict[int, Column],
    labels: LabelSet,
    hints: ImportHints,
    collector: ImportCollector,
) -> None:
    if len(row) != max(start, max(columns) + 1) and len(row) <= max(columns):
        raise AnnotationError(f"{where}: has {len(row)} cells; the header has more.")
    place = _find_image(where, "/".join(cell for cell in row[:start] if cell), labels, hints, collector)
    if place is None:
        return
    shift = PIXEL_CENTRE if hints.pixel_centre is None else hints.pixel_centre
    marks = {hand: np.full((len(HAND_JOINTS), 2), np.nan) for hand in SIDES}
    for i, (hand, joint, axis) in columns.items():
        marks[hand][joint, axis] = _read_cell(where, row[i]) - shift
    for hand, pixels in marks.items():
        half = np.isnan(pixels).any(axis=1) & ~np.isnan(pixels).all(axis=1)
        if half.any():
            raise AnnotationError(
                f"{where}: {HAND_JOINTS[int(np.argmax(half))]} has one of x and y; needed both or none."
            )
        there = np.asarray(~np.isnan(pixels).any(axis=1))
        if there.any():
            points = np.c_[np.where(there[:, None], pixels, 0.0), np.where(there, 2.0, 0.0)]
            collector.add(labels.key, Annotation(place[1], place[0], hand, points))


def _find_image(
    where: str, path: str, labels: LabelSet, hints: ImportHints, collector: ImportCollector
) -> Place | None:
    found = labels.names.find(path, hints.camera)
    if len(found) > 1:
        collector.problems.add(
            "{n} [row names|rows name] an image that several cameras have; give the option camera", path
        )
    elif not found:
        collector.warnings.add(
            "{n} [row names an image that is|rows name images that are] not in the recording and [was|were] left out",
            path or where,
        )
    return found[0] if len(found) == 1 else None


def _read_cell(where: str, text: str) -> float:
    text = text.strip()
    if text in ("", "nan", "NaN", "NA", "None"):
        return math.nan
    try:
        value = float(text) if len(text) < 50 else math.inf
    except ValueError:
        value = math.inf
    if not -MAX_PIXEL <= value <= MAX_PIXEL:
        raise AnnotationError(
            f"{where}: holds {text[:40]!r}; needed px from {-MAX_PIXEL:g} to {MAX_PIXEL:g} or nothing."
        )
    return value
