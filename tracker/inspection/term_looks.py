"""The looks of all terms, by the names under which a track holds their costs."""

from __future__ import annotations

from dataclasses import replace

from tracker.terms.collision import Collision
from tracker.terms.contours import Contours
from tracker.terms.data_to_model import DataToModel
from tracker.terms.data_to_surface import DataToSurface
from tracker.terms.flow import Flow
from tracker.terms.joint_prior import AnatomicalLimits, Bending, Regularization
from tracker.terms.look import TermLook
from tracker.terms.marked_joints import MarkedJoints
from tracker.terms.model_to_data import ModelToData
from tracker.terms.nails import Nails
from tracker.terms.physics import Supported
from tracker.terms.salient import Salient
from tracker.terms.silhouette import Silhouette
from tracker.terms.uncovered import Uncovered

TERMS = (
    ModelToData,
    DataToSurface,
    DataToModel,
    Silhouette,
    Uncovered,
    Collision,
    Salient,
    Nails,
    Supported,
    Contours,
    Flow,
    MarkedJoints,
    AnatomicalLimits,
    Regularization,
    Bending,
)
"""Every class that is a summand of the objective; a new one is added here."""

LOOKS = {term.look.name: term.look for term in TERMS}

MARKS = replace(MarkedJoints.look, name="marks", label="Marks")
"""Joints that a person marked in the first frame, in place of those that a detector saw."""


def find_term_look(name: str) -> TermLook:
    """How the term of this name is shown.

    Args:
        name: Of a summand, or of its part in one of several cameras, which has the camera's name before or behind it
            ("contours_cam1"). One that no term has, of a track that another version made, is grey and dotted.
    """
    if name in LOOKS:
        return LOOKS[name]
    for known, look in {**LOOKS, MARKS.name: MARKS}.items():
        for rest in (name.removeprefix(f"{known}_"), name.removesuffix(f"_{known}")):
            if rest != name:
                return replace(look, name=name, label=f"{look.label}, {rest}")
    return TermLook(name, name.replace("_", " ").capitalize(), "#9aa4ae", "#5f6b76", (1, 3))
