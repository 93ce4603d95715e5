"""The report: from the rows of all studies to the files in `benchmarks/results`."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from benchmarks.studies.blocks import Block, Picture, Section, Text
from benchmarks.studies.markdown import PICTURES, write_markdown
from benchmarks.studies.page import write_page
from benchmarks.studies.study import Row, Study
from tracker.capture.atomic_file import write_atomically

TITLE = "Studies: capturing hands in action, on twins"
PREFACE = (
    "Handloom's tracker follows twins of the eight public sequences of T16 (Tzionas et al., Capturing hands in action "
    "using discriminative salient points and physics simulation, IJCV 2016): the authors' own motions and models, "
    "rendered anew with the noise of a structured-light sensor (docs/recordings.md). Each section is the analogue of "
    "one of the paper's tables or figures, with the paper's numbers beside ours, set apart.",
    "**What is comparable is how settings compare with each other, not the pixels.** The paper's recordings and "
    "annotations are not at hand, nor are the motions of its other sequences; its error of 5.12 px is that of a "
    "scanned model on real images against manual marks (annotators differ by 1.5 px). A twin is rendered from the "
    "very model that is tracked, with exact truth and simpler noise, so an error of half a pixel here says that "
    "optimisation and correspondences do their work, and not that a real hand would be followed ten times as exactly "
    "as by T16.",
    "Ablations (tables 2 to 6, 11 to 13, figure 16) are Algorithm 1 alone: no second try, no search of the image, "
    "which would hide what a term does; they follow every third frame of the whole sequences, where motions are "
    "larger and settings differ. Tables 7, 8 and 14 and the bars are the tracker as it comes. Ours are means over the "
    "21 joints of every hand and all frames; a hand is lost in a frame when its mean error exceeds 40 mm. In the "
    "authors' file of sequence 12 the hand stands still for the first 419 of 727 frames: ablations and the comparison "
    "with the swarm begin after them.",
    "Not here: tables 9 and 10 (Dexter, whose recordings are not at hand) and tables 15, 16 and figure 17 (eight "
    "colour cameras).",
)


@dataclass(frozen=True)
class StudyRows:
    """The rows of a study as they are kept.

    Attributes:
        name: Of the study.
        quick: Whether only the first frames were run.
        codes: Fingerprints of the code that made the results.
        rows: Plain values.
    """

    name: str
    quick: bool
    codes: list[str]
    rows: list[Row]

    def save(self, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        write_atomically(folder / f"{self.name}.json", (json.dumps(asdict(self), indent=1) + "\n").encode())


def load_rows(name: str, folder: Path) -> StudyRows | None:
    """What `save` wrote, None where it did not."""
    path = folder / f"{name}.json"
    return StudyRows(**json.loads(path.read_text())) if path.is_file() else None


def load_all_rows(studies: Sequence[Study], *folders: Path) -> dict[str, StudyRows]:
    """The rows of every study from the first folder that has them."""
    found = {}
    for study in studies:
        for folder in folders:
            own = load_rows(study.name, folder)
            if own is not None:
                found[study.name] = own
                break
    return found


def build_sections(studies: Sequence[Study], rows: dict[str, StudyRows]) -> list[Section]:
    """A section for each study; one without rows says so."""
    sections = []
    for study in studies:
        own = rows.get(study.name)
        blocks: list[Block] = [Text("Not run.")] if own is None else study.show(own.rows)
        if own is not None and own.quick:
            blocks.insert(0, Text("**A trial run: the first 40 frames of each sequence only. Not to be quoted.**"))
        text = (study.paper, study.question, study.same, study.differs)
        sections.append(Section(study.name, study.title, *text, tuple(blocks)))
    return sections


def describe_code(rows: dict[str, StudyRows]) -> str:
    """A sentence on what made the rows."""
    codes = sorted({code for own in rows.values() for code in own.codes})
    made = f"one state of the code ({codes[0]})" if len(codes) == 1 else f"{len(codes)} states of the code"
    return f"Made by `python -m benchmarks.studies DATA --write` (DATA: the authors' folder) with {made}."


def write_report(studies: Sequence[Study], rows: dict[str, StudyRows], results: Path) -> list[Path]:
    """`studies.md`, and in `studies/` the page and the plots; the files written."""
    sections = build_sections(studies, rows)
    preface = [*PREFACE, describe_code(rows)]
    folder = results / PICTURES
    folder.mkdir(parents=True, exist_ok=True)
    files = {
        results / "studies.md": write_markdown(TITLE, [*preface, "[As one page](studies/report.html)."], sections),
        folder / "report.html": write_page(TITLE, preface, sections),
    }
    for section in sections:
        for block in section.blocks:
            if isinstance(block, Picture):
                files[folder / f"{block.name}.svg"] = block.svg
    for path, content in files.items():
        write_atomically(path, content.encode())
    return list(files)
