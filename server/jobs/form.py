"""The form of a tracking job, made from the tracker's own options."""

from __future__ import annotations

import dataclasses
from typing import Literal

from server.jobs.schemas import JobForm, JobFormField, JobPreset

TYPE_NAMES: dict[type, Literal["integer", "number", "boolean", "text"]] = {
    int: "integer",
    float: "number",
    bool: "boolean",
    str: "text",
}


def track_form() -> JobForm:
    """One field for each option, and the presets."""
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
        ],
        presets=[JobPreset.model_validate(preset) for preset in PRESETS],
        usual_preset=USUAL_PRESET,
    )
