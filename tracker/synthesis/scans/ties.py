"""Where the vertices of the untrained hand lie on the generator's surface, and which part of it is hand."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt
from scipy.sparse import csr_matrix

from tracker.model.decimation import find_surface_points
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.subject import MEAN_SUBJECT, load_subject, load_surface

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

OVERHANG = 0.002
"""Skin that lies farther up the arm than the untrained hand's border is no part of the hand; with this to spare, m."""


@dataclass(frozen=True)
class Ties:
    """The untrained hand on the surface of all subjects.

    Attributes:
        matrix: (T, V) its vertices from those that are deformed: points of the scanned surface.
        distances: (T,) how far they are from it on the mean subject at rest, m.
        faces: (F, 3) of the untrained right hand.
        along_arm: (W,) where the vertices of the scanned surface are along the arm on the mean subject at rest, m from
            the untrained hand's border, positive towards the fingers.
    """

    matrix: csr_matrix
    distances: Array
    faces: Ints
    along_arm: Array


@cache
def load_ties() -> Ties:
    """The ties; found once a process."""
    model = untrained_hand("right")
    surface = load_surface()
    rest = surface.fine @ load_subject(MEAN_SUBJECT).vertices
    points = find_surface_points(model.template, rest, surface.fine_faces)
    rows = np.repeat(np.arange(len(model.template)), 3)
    pick = csr_matrix((points.shares.ravel(), (rows, points.corners.ravel())), shape=(len(model.template), len(rest)))
    distances = np.linalg.norm(pick @ rest - model.template, axis=1)
    border = border_vertices(model.faces)
    start = float(model.template[border, 0].mean()) if len(border) else float(model.template[:, 0].min())
    return Ties(csr_matrix(pick @ surface.fine), distances, model.faces, rest[:, 0] - start)


def border_vertices(faces: Ints) -> Ints:
    """Vertices on edges with one face."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[counts == 1])
