"""The form of a tracking job, made from the tracker's own options."""

from __future__ import annotations

import dataclasses
from typing import Literal

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.detectors.models import DetectorRow
from server.hand_models.models import HandModelRow
from server.jobs.service import DETECTOR, HAND_MODEL
from server.jobs.track_schemas import JobForm, JobFormField, JobPreset

TYPE_NAMES: dict[type, Literal["integer", "number", "boolean", "text"]] = {
    int: "integer",
    float: "number",
    bool: "boolean",
    str: "text",
}


def track_form(session: Session) -> JobForm:
    """One field for each option, one for the hand model, one for the fingertip detector, and the presets.

    Physics is offered where it can be used; elsewhere the field of the terms says why not.
    """
    from tracker import PRESETS, USUAL_PRESET, TrackOptions, find_physics_fault

    fault = find_physics_fault()
    defaults = TrackOptions().to_json()
    fields = [
        JobFormField(
            name=option.name,
            label=option.metadata["label"],
            type=TYPE_NAMES[type(defaults[option.name])],
            default=defaults[option.name],
            help=option.metadata["help"],
            choices=option.metadata.get("choices"),
            choice_labels=option.metadata.get("choice_labels"),
            low=option.metadata.get("low"),
            high=option.metadata.get("high"),
            unit=option.metadata.get("unit"),
            is_advanced=option.metadata.get("is_advanced", False),
            about=option.metadata.get("about", "method"),
        )
        for option in dataclasses.fields(TrackOptions)
    ]
    presets = [JobPreset.model_validate(preset) for preset in PRESETS]
    if fault:
        fields = [_without_physics(field, fault) if field.name == "terms" else field for field in fields]
        presets = [preset for preset in presets if not _has_physics(preset.values["terms"])]
    return JobForm(
        kind="track",
        fields=[*fields, _choose_hand(session), _choose_detector(session)],
        presets=presets,
        usual_preset=USUAL_PRESET,
    )


def _without_physics(field: JobFormField, fault: str) -> JobFormField:
    """The field of the terms without those of physics, and why."""
    assert field.choices is not None and field.choice_labels is not None
    pairs = zip(field.choices, field.choice_labels, strict=True)
    kept = {name: label for name, label in pairs if not _has_physics(name)}
    offered = {"choices": list(kept), "choice_labels": list(kept.values()), "help": f"{field.help} {fault}"}
    return field.model_copy(update=offered)


def _has_physics(terms: object) -> bool:
    return "P" in str(terms).partition("+")[2]


MOST_OFFERED = 100
"""Of those that were trained or uploaded, the newest are offered."""


def _choose_hand(session: Session) -> JobFormField:
    from tracker import BUILT_IN_HANDS

    text = "What the hands are taken to be; the other hand is its mirror image."
    built_in = {"": "The default hand"} | {hand.name: hand.label for hand in BUILT_IN_HANDS.values()}
    return _choose(HAND_MODEL, "Hand model", text, built_in | _list_newest(session, HandModelRow))


def _choose_detector(session: Session) -> JobFormField:
    text = "Your own, added on the page Models, looks in every frame."
    own = _list_newest(session, DetectorRow)
    return _choose(DETECTOR, "Fingertip detector", text, {"": "The one that comes with Handloom"} | own)


def _list_newest(session: Session, row: type[HandModelRow] | type[DetectorRow]) -> dict[str, str]:
    """Ids and names of what was stored and not deleted."""
    query = select(row.id, row.name).where(row.deleted_at.is_(None)).order_by(row.created_at.desc(), row.id)
    return {str(found.id): found.name for found in session.execute(query.limit(MOST_OFFERED))}


def _choose(name: str, label: str, text: str, choices: dict[str, str]) -> JobFormField:
    return JobFormField(
        name=name,
        label=label,
        type="text",
        default="",
        help=text,
        choices=list(choices),
        choice_labels=list(choices.values()),
        low=None,
        high=None,
        unit=None,
        is_advanced=False,
        about="recording",
    )
