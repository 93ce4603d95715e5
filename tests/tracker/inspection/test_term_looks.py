"""Terms as people see them: named, and told apart by everybody on either ground."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import numpy.typing as npt
import pytest

from tracker.fitting.objective import Objective
from tracker.inspection.term_looks import LOOKS, TERMS, find_term_look

Array = npt.NDArray[np.float64]

GROUNDS = {"color": "#1c1f24", "color_on_white": "#ffffff"}
"""The lightest dark and the lightest light ground of a plot."""

# Machado, Oliveira and Fernandes 2009, at full severity; linear RGB.
SEEN_BY: dict[str, list[list[float]]] = {
    "everybody else": [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
    "protanopes": [[0.152, 1.053, -0.205], [0.115, 0.786, 0.099], [-0.004, -0.048, 1.052]],
    "deuteranopes": [[0.367, 0.861, -0.228], [0.280, 0.673, 0.047], [-0.012, 0.043, 0.969]],
    "tritanopes": [[1.256, -0.077, -0.179], [-0.078, 0.931, 0.148], [0.005, 0.691, 0.304]],
}


def linear(color: str) -> Array:
    channels = np.array(list(bytes.fromhex(color[1:]))) / 255
    return np.where(channels <= 0.04045, channels / 12.92, ((channels + 0.055) / 1.055) ** 2.4)


def luminance(color: str) -> float:
    return float(linear(color) @ [0.2126, 0.7152, 0.0722])


def lab(rgb: Array) -> Array:
    xyz = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]) @ rgb
    x, y, z = np.cbrt(np.clip(xyz / [0.9505, 1.0, 1.089], 1e-6, None))
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def test_every_summand_of_the_objective_has_a_name_and_a_look_of_its_own():
    objective = Objective()
    for term in (*objective.terms.values(), objective.anatomy, objective.regularization, objective.bending):
        assert type(term) in TERMS, f"add {type(term).__name__} to tracker/inspection/term_looks.py"
    assert set(objective.terms) <= set(LOOKS)
    assert len(LOOKS) == len(TERMS) == len({look.label for look in LOOKS.values()})


@pytest.mark.parametrize("which", GROUNDS)
@pytest.mark.parametrize("people", SEEN_BY)
def test_no_two_terms_look_alike_to(people: str, which: str):
    sight = np.array(SEEN_BY[people])
    seen = {name: lab(np.clip(sight @ linear(getattr(look, which)), 0, 1)) for name, look in LOOKS.items()}
    distances = {(a, b): float(np.linalg.norm(seen[a] - seen[b])) for a, b in combinations(seen, 2)}
    nearest = min(distances, key=lambda pair: distances[pair])
    assert distances[nearest] > 15, f"{nearest}: {distances[nearest]:.1f}"


@pytest.mark.parametrize("which", GROUNDS)
def test_every_curve_stands_out_from_its_ground(which: str):
    ground = luminance(GROUNDS[which])
    for look in LOOKS.values():
        own = luminance(getattr(look, which))
        contrast = (max(own, ground) + 0.05) / (min(own, ground) + 0.05)
        assert contrast >= 3, f"{look.name}: {contrast:.1f}"  # WCAG 2.2, 1.4.11: graphical objects


def test_a_part_in_one_camera_looks_like_its_term_and_says_the_camera():
    look = find_term_look("contours_cam1")
    assert (look.label, look.color) == ("Contours, cam1", LOOKS["contours"].color)
    assert find_term_look("depth_cam0_model_to_data").label == "Model to data, depth_cam0"
    assert find_term_look("marks_right").label == "Marks, right"


def test_a_term_of_another_version_is_grey_and_dotted():
    look = find_term_look("gravity_of_ropes")
    assert (look.label, look.dash) == ("Gravity of ropes", (1, 3))
    assert look.color not in {known.color for known in LOOKS.values()}
