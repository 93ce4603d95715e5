"""The unit of a mesh is told, or shown as a guess, and never one that makes an object no hand can hold."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest

from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.object_units import FIELD, ObjectCheck, write_size
from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackerError


@dataclass(frozen=True)
class Mesh:
    """A cube of 50 units; every unit but millimetres is a fault."""

    guess: float | None = 0.001
    sides: tuple[float, float, float] = (50.0, 50.0, 50.0)
    units: tuple[tuple[str, float], ...] = (("metres", 1.0), ("millimetres", 0.001))

    def find_fault(self, metres_per_unit: float) -> str:
        return "" if metres_per_unit == 0.001 else "it would be too large"


BOX = RecordedObject("box", "box.obj")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "box.obj").write_text("v 0 0 0")
    return tmp_path


def check(folder: Path, item: RecordedObject = BOX, mesh: Mesh | Exception | None = Mesh(), **options: float):
    """The item, its report, and what was found."""

    def measure(path: Path) -> Mesh | None:
        assert path == folder / item.model
        if isinstance(mesh, Exception):
            raise mesh
        return mesh

    found = Findings()
    looked = ObjectCheck(found)
    return *looked._check_one(item, folder, ImportOptions(**options), measure), found, looked.takes


def test_a_guess_is_taken_and_asked_for_with_every_unit_to_choose(folder: Path) -> None:
    item, report, found, takes = check(folder)
    assert (item.metres_per_unit, report.metres_per_unit, report.is_guessed) == (0.001, 0.001, True)
    assert report.size_m == pytest.approx((0.05, 0.05, 0.05)) and takes == (FIELD,)
    (question,) = found.questions
    assert (question.field, question.proposal) == (FIELD, 0.001) and found.problems == []
    assert [choice.value for choice in question.choices] == [1.0, 0.001]
    assert "5 x 5 x 5 cm large: is that right?" in found.warnings[0]


def test_what_was_told_is_taken_without_a_warning(folder: Path) -> None:
    item, report, found, _ = check(folder, object_unit_m=0.001)
    assert item.metres_per_unit == 0.001 and not report.is_guessed
    assert found.warnings == found.problems == [] and len(found.questions) == 1, "it may still be corrected"


def test_a_unit_that_makes_it_too_large_is_refused_whoever_said_it(folder: Path) -> None:
    _, _, found, _ = check(folder, object_unit_m=1.0)
    assert "with a unit of 1 m it would be too large. Give another unit." in found.problems[0]
    assert found.questions[0].field == FIELD
    own = RecordedObject("box", "box.obj", metres_per_unit=1.0)
    _, _, found, takes = check(folder, own)
    assert "that sequence.json says, it would be too large" in found.problems[0] and takes == ()
    assert found.questions == [], "it is corrected in the file"


def test_without_a_usual_unit_somebody_must_say_it(folder: Path) -> None:
    item, report, found, _ = check(folder, mesh=Mesh(guess=None))
    assert item.metres_per_unit is None and report.size_m == ()
    assert "50 x 50 x 50 units large; no usual unit" in found.problems[0]


def test_a_file_that_knows_its_unit_or_is_not_there_is_not_asked_about(folder: Path) -> None:
    for item in (BOX, RecordedObject("cup", "cup.obj")):
        same, report, found, _ = check(folder, item, mesh=None)
        assert same is item and report.metres_per_unit is None and found == Findings()


def test_a_mesh_that_cannot_be_read_is_a_reason_to_refuse(folder: Path) -> None:
    _, _, found, _ = check(folder, mesh=TrackerError("it is damaged"))
    assert found.problems == ["Object 'box': it is damaged"]


def test_sizes_are_written_in_centimetres() -> None:
    assert write_size((0.052, 1.0, 0.0123), 1.0) == "5.2 x 100 x 1.23 cm"
