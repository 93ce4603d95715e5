"""Normals at vertices: unit, outwards, weighted by area, zero where there is no surface."""

import numpy as np
import pytest

from tracker.geometry.vertex_normals import find_unit_normals
from tracker.model.untrained_hand import untrained_hand


def test_they_are_those_of_plain_numpy():
    hand = untrained_hand()
    vertices, faces = hand.template, np.asarray(hand.faces)
    corners = vertices[faces]
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    expected = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(expected, faces[:, k], areas)
    expected /= np.linalg.norm(expected, axis=1, keepdims=True)
    assert find_unit_normals(vertices, faces) == pytest.approx(expected, abs=1e-12)


def test_the_larger_triangle_counts_more():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 3]])
    normals = find_unit_normals(vertices, np.array([[0, 1, 2], [0, 2, 3]]))
    assert normals[0] == pytest.approx(np.array([3.0, 0.0, 1.0]) / np.sqrt(10.0))


def test_a_vertex_without_triangles_or_area_has_none():
    vertices = np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]])
    assert not find_unit_normals(vertices, np.array([[0, 1, 2]])).any()
