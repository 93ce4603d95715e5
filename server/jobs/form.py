"""The form of a tracking job, made from the tracker's own options."""

from __future__ import annotations

import dataclasses
from typing import Literal

from server.jobs.schemas import JobForm, JobFormField

TYPE_NAMES: dict[type, Literal["integer", "number", "boolean", "text"]] = {
    int: "integer",
    float: "number",
    bool: "boolean",
    str: "text",
}


def track_form() -> JobForm:
    """One field for each option."""
    from tracker import TrackOptions

    defaults = TrackOptions().to_json()
    return JobForm(
        kind="track",
        fields=[
            JobFormField(
                name=option.name,
                type=TYPE_NAMES[type(defaults[option.name])],
                default=defaults[option.name],
                help=option.metadata["help"],
                choices=option.metadata.get("choices"),
            )
            for option in dataclasses.fields(TrackOptions)
        ],
    )
