"""What must be said about a recording before it can be imported, all of it at once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any, Literal

from tracker.capture.sensor_presets import SensorFit

Kind = Literal["number", "choice", "boolean"]

_FIELDS: dict[str, tuple[str, Kind, str]] = {
    "format": ("Kind of recording", "choice", ""),
    "depth_pattern": ("Depth images", "choice", ""),
    "color_pattern": ("Colour images", "choice", ""),
    "preset": ("Sensor", "choice", ""),
    "intrinsics": ("Camera of the benchmark", "choice", ""),
    "fx": ("Focal length fx", "number", "px"),
    "fy": ("Focal length fy", "number", "px"),
    "cx": ("Principal point cx", "number", "px"),
    "cy": ("Principal point cy", "number", "px"),
    "depth_scale": ("Depth unit", "number", "m"),
    "world_unit_m": ("Unit of the calibration", "number", "m"),
    "object_unit_m": ("Unit of the objects' meshes", "number", "m"),
    "fps": ("Frames per second", "number", "1/s"),
    "hands": ("Hands seen", "choice", ""),
    "camera_shifts": ("Videos out of step", "choice", ""),
    "allow_gaps": ("Import although frames are missing", "boolean", ""),
}


@dataclass(frozen=True)
class ImportChoice:
    """One of the answers to a question.

    Attributes:
        value: To be given as the option.
        label: For people.
        count: Files behind it; 0 when it stands for none.
        detail: What kind of images they are.
        pictures: Names of its first, middle and last image.
    """

    value: Any
    label: str
    count: int = 0
    detail: str = ""
    pictures: tuple[str, ...] = ()


@dataclass(frozen=True)
class ImportQuestion:
    """An option that is missing, ambiguous or cannot be right.

    Attributes:
        field: Name of the option.
        label: For people.
        kind: What an answer is.
        unit: Of a number.
        ask: What is needed and why, to stand beside the field.
        problem: The report's sentence that the answer mends; empty when the import is possible without.
        is_required: Nothing is imported before it is answered.
        proposal: An answer that may be right, or None; never taken by itself.
        proposed_by: Where the proposal comes from.
        choices: The answers there are.
    """

    field: str
    label: str
    kind: Kind
    unit: str
    ask: str
    problem: str = ""
    is_required: bool = True
    proposal: Any = None
    proposed_by: str = ""
    choices: tuple[ImportChoice, ...] = ()


def make_question(field: str, ask: str, problem: str = "", **more: Any) -> ImportQuestion:
    """A question about one of the options; without a problem it may stay unanswered."""
    label, kind, unit = _FIELDS[field]
    is_required = more.pop("is_required", bool(problem))
    return ImportQuestion(field, label, kind, unit, ask, problem, is_required, **more)


def merge_questions(questions: Iterable[ImportQuestion], sensors: tuple[SensorFit, ...]) -> tuple[ImportQuestion, ...]:
    """One question for each option, in a fixed order, with the values of the likeliest sensor as proposals."""
    found: dict[str, ImportQuestion] = {}
    for question in questions:
        known = found.get(question.field)
        if known is None or (question.is_required and not known.is_required):
            found[question.field] = question
    guess = next((fit for fit in sensors if fit.is_guess), None)
    if guess is not None:
        for field, value in guess.values.items():
            if field in found and found[field].proposal is None:
                found[field] = replace(found[field], proposal=value, proposed_by=f"typical of {guess.label}")
    order = list(_FIELDS)
    return tuple(sorted(found.values(), key=lambda question: order.index(question.field)))
