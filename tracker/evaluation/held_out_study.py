"""A trained model on people it has not seen, beside what it would be without each of its parts: [R17] Fig. 12-14."""

from __future__ import annotations

import logging
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.errors import TrainingError
from tracker.evaluation.held_out import HeldOut
from tracker.evaluation.model_study import TestHand, find_template, generalize_poses, judge_model, measure_floor
from tracker.evaluation.scan_fit import without_pose_shapes
from tracker.model.blend_model import BlendModel
from tracker.training.checkpoints import Checkpoints, NoCheckpoints, PrefixedCheckpoints
from tracker.training.options import TrainingOptions
from tracker.training.train import train_model
from tracker.training.training_set import TrainingSet

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

LEARNED, SHAPES_OFF, PLAIN, RIGHT_ONLY = "learned", "blend shapes off", "plain skinning", "right hands only"


@dataclass(frozen=True)
class StudyLevel:
    """How thorough a study is.

    Attributes:
        hands: Judged, at most.
        curve_hands: Of those, for the curve over pose components.
        counts: Of pose components.
        trains_others: Whether plain skinning, and a model without mirrored hands, are trained to compare with.
    """

    hands: int
    curve_hands: int
    counts: tuple[int, ...]
    trains_others: bool


STUDY_LEVELS = {
    "quick": StudyLevel(24, 12, (0, 2, 5, 10, 20, 45), trains_others=False),
    "full": StudyLevel(96, 32, (0, 1, 2, 3, 4, 6, 8, 10, 15, 20, 30, 45), trains_others=True),
}


def study_held_out(
    learned: BlendModel,
    compared: Mapping[str, BlendModel],
    held_out: HeldOut,
    training_set: TrainingSet,
    initial: BlendModel,
    options: TrainingOptions,
    level: StudyLevel,
    progress: Progress | None = None,
    checkpoints: Checkpoints | None = None,
) -> dict[str, Any]:
    """What is written of a model after it was judged, as JSON.

    Args:
        learned: The model.
        compared: Others by name, such as the untrained hand; with pose and shape fitted.
        held_out: People that none of them was trained on.
        training_set, initial, options: What the model was trained from and how: others are trained alike but for one
            thing.
        level: How thorough.
        progress: Told what is under way and the share done; may raise to cancel.
        checkpoints: Where each finished part of just this study is kept.

    Returns:
        `models` (pose and shape fitted) and `own_template` (the pose alone): by name the mean and the standard
        deviation of the distances of scans, and the mean of vertices, mm; `pose_generalisation`: by name the distance
        of scans by the number of pose components; `floor_mm`: the registrations themselves; `not_compared`: why not.
    """
    began = time.monotonic()
    kept, say = checkpoints or NoCheckpoints(), progress or (lambda stage, share: None)
    others = _list_others(training_set, options) if level.trains_others else {}
    share = 0.5 if others else 0.0
    trained, refused = _train_others(others, training_set, initial, kept, lambda stage, done: say(stage, share * done))
    models = {LEARNED: learned, **trained}
    fitted = {**models, **compared}
    templates, posed, curves = {}, {}, {}
    if templated := held_out.with_template:
        templates = {
            name: {who: find_template(model, flat) for who, flat in held_out.flats.items()}
            for name, model in models.items()
        }
        plain = {SHAPES_OFF: without_pose_shapes(learned)} if learned.pose_directions.any() else {}
        posed = {**models, **plain}
        curves = {name: models[name] for name in (LEARNED, RIGHT_ONLY) if name in models}
    judge = _Judge(kept, lambda stage, done: say(stage, share + (1.0 - share) * done))
    judge.expect(len(fitted) + len(posed) + len(level.counts) * len(curves))
    few = templated[:: max(1, len(templated) // level.curve_hands)][: level.curve_hands]
    return {
        "people": sorted({hand.subject for hand in held_out.hands}),
        "scans": len(held_out.hands),
        "floor_mm": round(measure_floor(learned, held_out.hands), 4),
        "models": {name: judge.rate(name, model, held_out.hands, None) for name, model in fitted.items()},
        "own_template": {
            name: judge.rate(name, model, templated, templates.get(name, templates[LEARNED]))
            for name, model in posed.items()
        },
        "pose_generalisation": {
            name: judge.draw_curve(name, model, few, templates[name], level.counts) for name, model in curves.items()
        },
        "not_compared": refused,
        "seconds": round(time.monotonic() - began, 1),
    }


def _train_others(
    others: Mapping[str, TrainingOptions],
    training_set: TrainingSet,
    initial: BlendModel,
    kept: Checkpoints,
    say: Progress,
) -> tuple[dict[str, BlendModel], dict[str, str]]:
    """Models trained alike but for one thing, and why a name has none."""
    models, refused = {}, {}
    for number, (name, changed) in enumerate(others.items()):

        def tell(stage: str, share: float, name: str = name, number: int = number) -> None:
            say(f"{name}: {stage}", (number + share) / len(others))

        try:
            own = PrefixedCheckpoints(kept, name.replace(" ", "-"))
            models[name] = train_model(training_set, initial, replace(changed, name=name), tell, own).model
        except TrainingError as error:
            refused[name] = str(error)
            log.warning("%s cannot be compared: %s", name, error)
    return models, refused


def _list_others(training_set: TrainingSet, options: TrainingOptions) -> dict[str, TrainingOptions]:
    """Trainings that differ from that of the model in one thing."""
    others = {}
    if options.with_pose_shapes:
        others[PLAIN] = replace(options, with_pose_shapes=False)
    if options.with_mirrored and training_set.mirrored.any():
        others[RIGHT_ONLY] = replace(options, with_mirrored=False)
    return others


class _Judge:
    """Judges models on hands, one part after the other; parts that are kept are not done again."""

    def __init__(self, kept: Checkpoints, say: Progress) -> None:
        self._kept, self._say, self._done, self._parts = kept, say, 0, 1

    def expect(self, parts: int) -> None:
        self._parts = max(1, parts)

    def rate(
        self, name: str, model: BlendModel, hands: Sequence[TestHand], templates: dict[str, Array] | None
    ) -> dict[str, float]:
        """Distances of scans and of vertices, mm."""
        how = "pose and shape" if templates is None else "pose"

        def work() -> dict[str, float]:
            errors = judge_model(model, hands, templates, None, self._tell(f"{name}: {how}"))
            return {
                "scan_to_mesh_mm": round(float(errors.scan_to_mesh.mean()), 4),
                "scan_to_mesh_sd_mm": round(float(errors.scan_to_mesh.std()), 4),
                "vertices_mm": round(float(errors.vertices.mean()), 4),
            }

        return self._do(f"{name} {how}", work)

    def draw_curve(
        self,
        name: str,
        model: BlendModel,
        hands: Sequence[TestHand],
        templates: dict[str, Array],
        counts: Sequence[int],
    ) -> list[dict[str, float]]:
        """[R17] Fig. 13."""
        most = len(model.pose_components)
        rows = []
        for count in sorted({min(count, most) for count in counts}):

            def work(count: int = count) -> dict[str, float]:
                self._tell(f"{name}: {count} pose components")(0.0)
                return generalize_poses(model, hands, templates, [count])[0]

            rows.append(self._do(f"{name} {count} components", work))
        return rows

    def _tell(self, stage: str) -> Callable[[float], None]:
        return lambda share: self._say(stage, (self._done + share) / self._parts)

    def _do(self, part: str, work: Callable[[], dict[str, float]]) -> dict[str, float]:
        stage = "judged-" + part.replace(" ", "-")
        arrays = self._kept.load(stage)
        if arrays is None:
            arrays = {key: np.array(value) for key, value in work().items()}
            self._kept.save(stage, arrays)
        self._done = min(self._done + 1, self._parts)
        return {key: array.item() for key, array in arrays.items()}
