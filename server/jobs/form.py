"""The form of a tracking job, made from the tracker's own options."""

from __future__ import annotations

import dataclasses
from typing import Literal

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.hand_models.models import HandModelRow
from server.jobs.schemas import JobForm, JobFormField, JobPreset
from server.jobs.service import HAND_MODEL, TRAINED_HAND

TYPE_NAMES: dict[type, Literal["integer", "number", "boolean", "text"]] = {
    int: "integer",
    float: "number",
    bool: "boolean",
    str: "text",
}


def track_form(session: Session) -> JobForm:
    """One field for each option, one for the hand model, and the presets."""
    from tracker import PRESETS, USUAL_PRESET, TrackOptions

    defaults = TrackOptions().to_json()
    return JobForm(
        kind="track",
        fields=[
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
        + [_choose_hand(session)],
        presets=[JobPreset.model_validate(preset) for preset in PRESETS],
        usual_preset=USUAL_PRESET,
    )


MOST_MODELS = 100
"""Of those that were trained or uploaded, the newest are offered."""


def _choose_hand(session: Session) -> JobFormField:
    query = select(HandModelRow.id, HandModelRow.name).where(HandModelRow.deleted_at.is_(None))
    rows = session.execute(query.order_by(HandModelRow.created_at.desc(), HandModelRow.id).limit(MOST_MODELS)).all()
    return JobFormField(
        name=HAND_MODEL,
        label="Hand model",
        type="text",
        default="",
        help="What the hands are taken to be; the other hand is its mirror image.",
        choices=["", TRAINED_HAND, *(str(row.id) for row in rows)],
        choice_labels=["The default hand", "The hand learnt from scans", *(row.name for row in rows)],
        low=None,
        high=None,
        unit=None,
        is_advanced=False,
        about="recording",
    )
