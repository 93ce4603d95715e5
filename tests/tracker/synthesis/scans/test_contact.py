"""Skin that has passed through other skin comes out again, and none is inside another at rest."""

from __future__ import annotations

import numpy as np

from tracker.synthesis.scans.contact import find_depths, give_way
from tracker.synthesis.scans.subject import BONES, load_subject, load_surface
from tracker.synthesis.scans.tissue import vertex_normals

SUBJECT, SURFACE = load_subject(6), load_surface()


def test_skin_that_was_pushed_through_other_skin_comes_back_out_and_the_rest_stays() -> None:
    finger = SURFACE.all_weights[:, [BONES.index(name) for name in BONES if name.startswith("index")]].sum(axis=1)
    pushed = SUBJECT.vertices.copy()
    middle = SUBJECT.joints[BONES.index("middle_middle")] - SUBJECT.joints[BONES.index("index_middle")]
    tip = finger > 0.99
    pushed[tip] += 0.45 * middle
    normals = vertex_normals(pushed, SURFACE.faces)
    before = find_depths(pushed, normals, SUBJECT.vertices)
    out = give_way(pushed, SUBJECT.vertices)
    after = find_depths(out, vertex_normals(out, SURFACE.faces), SUBJECT.vertices)
    assert before.max() > 1e-3 and after.sum() < 0.3 * before.sum()
    far = np.linalg.norm(SUBJECT.vertices - SUBJECT.joints[BONES.index("little_proximal")], axis=1) < 0.02
    assert np.allclose(out[far], pushed[far], atol=1e-9)
    assert not find_depths(SUBJECT.vertices, vertex_normals(SUBJECT.vertices, SURFACE.faces), SUBJECT.vertices).any()
