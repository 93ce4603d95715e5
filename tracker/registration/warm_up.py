"""Compile, or load from the cache, the kernels of registration before somebody waits for them."""

from __future__ import annotations

from tracker.capture.scan import Scan
from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.untrained_hand import untrained_hand
from tracker.registration.register import Registrar


def warm_up_registration() -> None:
    """Register the model's own vertices once."""
    model = untrained_hand()
    Registrar(model).register(Scan(model.template, find_unit_normals(model.template, model.faces)))
