"""The unit of the meshes that a recording names: said by somebody or shown as a guess, before anything is stored."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Protocol

from tracker.capture.import_findings import Findings
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_plan import ImportPlan
from tracker.capture.import_question import ImportChoice
from tracker.capture.recorded_object import RecordedObject
from tracker.errors import TrackerError

FIELD = "object_unit_m"


class MeshSize(Protocol):
    """How large a mesh is, as the room of models tells it."""

    @property
    def sides(self) -> tuple[float, float, float]: ...

    @property
    def guess(self) -> float | None: ...

    @property
    def units(self) -> tuple[tuple[str, float], ...]: ...

    def find_fault(self, metres_per_unit: float) -> str: ...


MeasureMesh = Callable[[Path], MeshSize | None]
"""The size of a model file; None of one that knows its unit. Recordings know no models: whoever imports gives it."""


@dataclass(frozen=True)
class ObjectReport:
    """An object of a recording.

    Attributes:
        name: Its name.
        size_m: Sides of the box around it, or empty when its file knows its unit.
        metres_per_unit: Of its file.
        is_guessed: The unit was not given; it was recognised by the size.
    """

    name: str
    size_m: tuple[float, ...] = ()
    metres_per_unit: float | None = None
    is_guessed: bool = False


def write_size(sides: tuple[float, float, float], metres_per_unit: float) -> str:
    """`5.2 x 5.2 x 5.0 cm`."""
    return " x ".join(f"{100 * side * metres_per_unit:.3g}" for side in sides) + " cm"


@dataclass
class ObjectCheck:
    """What a look at the objects of a plan finds."""

    found: Findings
    takes: tuple[str, ...] = ()

    def check(
        self, plan: ImportPlan, root: Path, options: ImportOptions, measure: MeasureMesh
    ) -> tuple[ImportPlan, tuple[ObjectReport, ...]]:
        """The plan with the unit of every mesh in it, and what to tell people of each object."""
        found = [self._check_one(item, root, options, measure) for item in plan.objects]
        return replace(plan, objects=tuple(item for item, _ in found)), tuple(told for _, told in found)

    def _check_one(
        self, item: RecordedObject, root: Path, options: ImportOptions, measure: MeasureMesh
    ) -> tuple[RecordedObject, ObjectReport]:
        path = root / item.model
        if not path.is_file():  # the importer has said so
            return item, ObjectReport(item.name)
        try:
            mesh = measure(path)
        except TrackerError as fault:
            self.found.refuse(f"Object {item.name!r}: {fault}")
            return item, ObjectReport(item.name)
        if mesh is None:
            return item, ObjectReport(item.name)
        told = item.metres_per_unit or options.object_unit_m
        unit = told or mesh.guess
        if item.metres_per_unit is None:
            self.takes = (FIELD,)
            self._ask(item, mesh, unit, is_guessed=told is None)
        elif fault := mesh.find_fault(item.metres_per_unit):
            self.found.refuse(
                f"{item.model}: with the unit of {item.metres_per_unit:g} m that sequence.json says, {fault}. Correct "
                "metres_per_unit of the object there."
            )
        if unit is None:
            return item, ObjectReport(item.name)
        size = tuple(side * unit for side in mesh.sides)
        return replace(item, metres_per_unit=unit), ObjectReport(item.name, size, unit, told is None)

    def _ask(self, item: RecordedObject, mesh: MeshSize, unit: float | None, *, is_guessed: bool) -> None:
        choices = tuple(
            ImportChoice(scale, f"{name.capitalize()}: {item.name} is {write_size(mesh.sides, scale)}")
            for name, scale in mesh.units
        )
        if unit is None:
            across = " x ".join(f"{side:.4g}" for side in mesh.sides)
            text = (
                f"{item.model}: {across} units large; no usual unit gives a size that a hand can hold. Give its unit."
            )
            self.found.refuse(text, FIELD, choices=choices)
        elif fault := mesh.find_fault(unit):
            text = f"{item.model}: with a unit of {unit:g} m {fault}. Give another unit."
            self.found.refuse(text, FIELD, choices=choices)
        elif is_guessed:
            said = write_size(mesh.sides, unit)
            text = f"The file of {item.name} does not say its unit. It is assumed to be {said} large: is that right?"
            self.found.warn(text)
            self.found.ask(FIELD, text, choices=choices, proposal=unit)
        else:
            self.found.ask(FIELD, f"{item.name} is {write_size(mesh.sides, unit)} large.", choices=choices)
