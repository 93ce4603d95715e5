"""A person's own template: registrations unposed and averaged, [R17] 4.3.1."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.bodies.body_registration import BodyRegistration
from tracker.model.blend_model import BlendModel
from tracker.model.body_hands import body_hand

Array = npt.NDArray[np.float64]


def unpose(model: BlendModel, registration: BodyRegistration) -> Array:
    """(V, 3) a registration's surface taken back to the zero pose, without pose blend shapes, m."""
    state = registration.state
    posed = state.posed(model)
    moved = np.einsum("vb,bxy->vxy", model.skinning_weights, posed.Ts)
    blended = posed.rest - posed.arrays.shaped
    back = np.linalg.solve(moved[:, :, :3], (registration.vertices - moved[:, :, 3])[:, :, None])[:, :, 0]
    return back - blended


def make_template(model: BlendModel, registrations: list[BodyRegistration]) -> BlendModel:
    """The model of one person, without shape directions.

    Differs from the paper: nobody picks the registrations by eye; the median of each coordinate is taken, and hands
    count only where the scan has them.

    Args:
        model: That of the registrations.
        registrations: Of the person, good ones.
    """
    assert registrations
    unposed = np.array([unpose(model, each) for each in registrations])
    template = np.median(unposed, axis=0)
    for k, side in enumerate(("left", "right")):
        shown = [number for number, each in enumerate(registrations) if each.are_shown[k]]
        ids = body_hand(model, side).vertices
        if shown:
            template[ids] = np.median(unposed[shown][:, ids], axis=0)
    provenance = {**model.provenance, "template": f"median of {len(registrations)} unposed registrations"}
    return replace(
        model,
        name=f"{model.name}, own template",
        template=template,
        shape_directions=np.zeros((len(template), 3, 0)),
        provenance=provenance,
    )
