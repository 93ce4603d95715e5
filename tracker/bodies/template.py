"""A person's own template: registrations unposed and averaged, [R17] 4.3.1."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.bodies.body_registration import BodyRegistration
from tracker.bodies.body_state import BodyState
from tracker.bodies.register_body import Registrar
from tracker.capture.scan import Scan
from tracker.errors import TrackerError
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_hand
from tracker.model.skinning import blend_motions, take_back

Array = npt.NDArray[np.float64]


def unpose(model: BlendModel, registration: BodyRegistration) -> Array:
    """(V, 3) a registration's surface taken back to the zero pose, without pose blend shapes, m."""
    state = registration.state
    posed = state.posed(model)
    back = take_back(blend_motions(model.skinning_weights, posed.Ts), registration.vertices)
    return back - (posed.rest - posed.arrays.shaped)


def make_template(model: BlendModel, registrations: Iterable[tuple[BlendModel, BodyRegistration]]) -> BlendModel:
    """The model of one person, without shape directions.

    Differs from the paper: nobody picks the registrations by eye; the median of each coordinate is taken, and hands
    count only where the scan has them.

    Args:
        model: A body with the mesh of all models.
        registrations: Of the person, good ones, each with the model it was made with. Looked at one by one.
    """
    unposed, are_shown = [], []
    for made_with, each in registrations:
        unposed.append(unpose(made_with, each))
        are_shown.append(each.are_shown)
    assert unposed
    surfaces, shown = np.array(unposed), np.array(are_shown)
    template = np.median(surfaces, axis=0)
    for k, side in enumerate(("left", "right")):
        ids = body_hand(model, side).vertices
        if shown[:, k].any():
            template[ids] = np.median(surfaces[shown[:, k]][:, ids], axis=0)
    provenance = {**model.provenance, "template": f"median of {len(unposed)} unposed registrations"}
    return replace(
        model,
        name=f"{model.name}, own template",
        template=template,
        shape_directions=np.zeros((len(template), 3, 0)),
        provenance=provenance,
    )


TEMPLATE_FRAMES, TEMPLATE_SPAN = 6, 50
"""So many frames, spread over the first 50, in which the person is mostly still ([R17] 4.3), make the template."""


def choose_template_frames(frames: Sequence[int], count: int = TEMPLATE_FRAMES, span: int = TEMPLATE_SPAN) -> list[int]:
    """At most `count` frames, spread over the first `span` of those given."""
    early = frames[:span]
    places = np.unique(np.linspace(0, len(early) - 1, min(count, len(early))).astype(int))
    return [early[place] for place in places]


def register_for_template(registrar: Registrar, scan: Scan, before: BodyRegistration | None) -> BodyRegistration:
    """A scan of the person from where the one before ended; without a start where that leads nowhere."""
    start = before.state if before is not None and before.verdict != "bad" else None
    registration = registrar.register(scan, start)
    if registration.verdict == "bad" and start is not None:
        registration = registrar.register(scan)
    return registration


def make_own_model(model: BlendModel, found: list[BodyRegistration]) -> BlendModel:
    """The person's model from those registrations that show one whole person.

    Raises:
        TrackerError: None does; says why the first does not.
    """
    good = [each for each in found if each.verdict != "bad"]
    if not good:
        why = "; ".join(found[0].reasons) if found else "none of its scans can be read"
        raise TrackerError(f"No frame of the sequence shows one whole person: {why}.")
    return make_template(model, ((model, each) for each in good))


def without_shape(registration: BodyRegistration) -> BodyState:
    """Where the person's own model begins that was made from the registration: the same pose, and no shape to find."""
    return replace(registration.state, shape=np.zeros(0))


def find_shape(model: BlendModel, own: BlendModel, weight: float = 1e-6) -> Array:
    """(S,) coefficients of a body that come nearest to a person's own template, for programs that know no template.

    Args:
        model: The body that the template was made from.
        own: The person's.
        weight: Of the coefficients' squares against squared distances of vertices, m².
    """
    directions = model.shape_directions.reshape(-1, model.num_shape)
    apart = (own.template - model.template).reshape(-1)
    found = np.linalg.solve(directions.T @ directions + weight * np.eye(model.num_shape), directions.T @ apart)
    return np.asarray(found, dtype=np.float64)
