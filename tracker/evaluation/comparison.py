"""Several tracks against annotations side by side: everything that tables, curves and reports show, in plain values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tracker.evaluation.evaluation import OCCLUDED, VISIBLE, Evaluation
from tracker.evaluation.paired import compare_paired, find_common
from tracker.evaluation.statistics import compute_shares_below, compute_statistics
from tracker.model.joints import HAND_JOINTS

WORST = 12
"""Images of the worst frames of each track."""
STEPS = 50
"""Thresholds of a PCK curve above 0 px."""
WITHIN_PX = 10.0
"""The threshold that tables show unless another is asked for, px."""
NOT_METHOD = ("first_frame", "last_frame", "camera", "threads")
"""Parameters that say what was tracked, or with what machine, and not how."""


@dataclass(frozen=True, eq=False)
class JudgedTrack:
    """A track with its errors and where both come from.

    Attributes:
        key: Tells it from the others.
        name: For people.
        recording_key: Tracks of one recording share it and are compared joint by joint.
        recording: Its name.
        parameters: Of the run.
        evaluation: Its errors.
        labels: Which annotations judged it, as plain values.
        origin: Which track this was, as plain values.
    """

    key: str
    name: str
    recording_key: str
    recording: str
    parameters: dict[str, Any]
    evaluation: Evaluation
    labels: dict[str, Any] = field(default_factory=dict)
    origin: dict[str, Any] = field(default_factory=dict)

    @property
    def method(self) -> tuple[tuple[str, Any], ...]:
        """The parameters that say how it was tracked; tracks of one method share them."""
        return tuple(sorted((name, value) for name, value in self.parameters.items() if name not in NOT_METHOD))


def compare_tracks(
    judged: Sequence[JudgedTrack], *, reference: str | None = None, within_px: float = WITHIN_PX
) -> dict[str, Any]:
    """The document of a comparison; errors in px. Without a reference nothing is compared pairwise.

    Tracks of one method in several recordings make one row of `methods`; of several in one recording the first counts.
    """
    thresholds = _find_thresholds(judged)
    chosen = next((one for one in judged if one.key == reference), None)
    return {
        "version": 1,
        "within_px": within_px,
        "thresholds_px": thresholds.tolist(),
        "reference": None if chosen is None else chosen.key,
        "joints": list(HAND_JOINTS),
        "tracks": [_describe_track(one, judged, chosen, within_px, thresholds) for one in judged],
        "methods": _describe_methods(judged, chosen, within_px),
        "parameters": _compare_parameters(judged),
    }


def _find_thresholds(judged: Sequence[JudgedTrack]) -> np.ndarray:
    tops = [compute_statistics(one.evaluation.error).p95 or 0.0 for one in judged]
    top = min(200.0, max(20.0, 10.0 * np.ceil(max(tops, default=0.0) / 10.0)))
    return np.linspace(0.0, top, STEPS + 1)


def _describe_track(
    one: JudgedTrack,
    judged: Sequence[JudgedTrack],
    chosen: JudgedTrack | None,
    within_px: float,
    thresholds: np.ndarray,
) -> dict[str, Any]:
    evaluation = one.evaluation
    fellows = [other for other in judged if other.recording_key == one.recording_key]
    _, common = find_common([evaluation, *(other.evaluation for other in fellows)])
    is_comparable = chosen is not None and chosen is not one and chosen.recording_key == one.recording_key
    paired = compare_paired([(evaluation, chosen.evaluation)]) if is_comparable and chosen is not None else None
    return {
        "key": one.key,
        "name": one.name,
        "recording_key": one.recording_key,
        "recording": one.recording,
        "parameters": one.parameters,
        "labels": one.labels,
        "origin": one.origin,
        "frames": len(evaluation.track_frame),
        "lost": len(evaluation.lost_frame),
        "lost_frames": evaluation.lost_frame.tolist(),
        "annotated": len(evaluation.frame) + len(evaluation.untracked),
        "evaluated": int(evaluation.is_judged.sum()),
        "annotated_frames": len(np.unique(evaluation.frame[evaluation.is_judged])),
        "sources": evaluation.count_sources(),
        "left_out_joints": int(evaluation.left_out.sum()),
        "untracked": len(evaluation.untracked),
        "error": evaluation.statistics.to_json(),
        "visible": evaluation.where(evaluation.visibility == VISIBLE).to_json(),
        "occluded": evaluation.where(evaluation.visibility == OCCLUDED).to_json(),
        "hands": {name: found.to_json() for name, found in evaluation.by_hand().items()},
        "cameras": {name: found.to_json() for name, found in evaluation.by_camera().items()},
        "by_joint": [found.to_json() for found in evaluation.by_joint()],
        "within": _share(evaluation.error, within_px),
        "shares": [_number(value) for value in compute_shares_below(evaluation.error, thresholds)],
        "curve": _describe_curve(evaluation),
        "common": compute_statistics(common[0]).to_json(),
        "paired": None if paired is None else paired.to_json(),
        "worst": [_describe_worst(evaluation, item) for item in evaluation.worst_items(WORST)],
    }


def _describe_curve(evaluation: Evaluation) -> dict[str, Any]:
    """Mean and largest error of the joints of each annotated frame."""
    frames, means, largest = [], [], []
    for frame in np.unique(evaluation.frame[evaluation.is_judged]):
        found = compute_statistics(evaluation.error[evaluation.frame == frame])
        frames.append(int(frame))
        means.append(found.mean)
        largest.append(found.max)
    return {"frame": frames, "mean": means, "max": largest}


def _describe_worst(evaluation: Evaluation, item: int) -> dict[str, Any]:
    worst = int(np.nanargmax(evaluation.error[item]))
    return evaluation.describe_item(item) | {"worst_joint": HAND_JOINTS[worst]}


def _describe_methods(
    judged: Sequence[JudgedTrack], chosen: JudgedTrack | None, within_px: float
) -> list[dict[str, Any]]:
    """One row for each method, its errors pooled over the recordings it was run on."""
    methods: dict[Any, dict[str, JudgedTrack]] = {}
    for one in judged:
        methods.setdefault(_key(one), {}).setdefault(one.recording_key, one)
    if chosen is not None:  # of several tracks of its method and recording, the reference itself
        methods[_key(chosen)][chosen.recording_key] = chosen
    differing = [name for name, values in _spread(judged).items() if len(values) > 1 and name not in NOT_METHOD]
    reference = {} if chosen is None else methods[_key(chosen)]
    return [_describe_method(runs, reference, differing, within_px) for runs in methods.values()]


def _describe_method(
    runs: dict[str, JudgedTrack], reference: dict[str, JudgedTrack], differing: list[str], within_px: float
) -> dict[str, Any]:
    """One method by its runs on each recording, beside the reference's; `differing` parameters name it."""
    parameters = next(iter(runs.values())).parameters
    found = [one.evaluation for one in runs.values()]
    errors = np.concatenate([one.error for one in found])
    pairs = [(one.evaluation, reference[key].evaluation) for key, one in runs.items() if key in reference]
    paired = compare_paired(pairs) if pairs and runs is not reference else None
    return {
        "name": ", ".join(f"{name} {word_of(parameters.get(name))}" for name in differing) or "all alike",
        "tracks": [one.key for one in runs.values()],
        "recordings": len(runs),
        "frames": sum(len(one.track_frame) for one in found),
        "lost": sum(len(one.lost_frame) for one in found),
        "error": compute_statistics(errors).to_json(),
        "within": _share(errors, within_px),
        "is_reference": runs is reference,
        "paired": None if paired is None else paired.to_json(),
    }


def _compare_parameters(judged: Sequence[JudgedTrack]) -> dict[str, Any]:
    spread = _spread(judged)
    return {
        "different": [
            {"name": name, "values": {one.key: one.parameters.get(name) for one in judged}}
            for name, values in spread.items()
            if len(values) > 1
        ],
        "same": {name: judged[0].parameters.get(name) for name, values in spread.items() if len(values) == 1},
    }


def _spread(judged: Sequence[JudgedTrack]) -> dict[str, set[str]]:
    """The distinct values of every parameter."""
    names = dict.fromkeys(name for one in judged for name in one.parameters)
    return {name: {repr(one.parameters.get(name)) for one in judged} for name in names}


def _key(one: JudgedTrack) -> str:
    return repr(one.method)


def word_of(value: Any) -> str:
    """A parameter's value for people."""
    if isinstance(value, bool):
        return "on" if value else "off"
    if value is None:
        return "–"
    return str(value) if value != "" else "automatic"


def _share(errors: np.ndarray, within_px: float) -> float | None:
    return _number(compute_shares_below(errors, np.array([within_px]))[0])


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
