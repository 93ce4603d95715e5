from xml.etree import ElementTree

import numpy as np

from tracker.evaluation.model_curves import draw_study
from tracker.evaluation.model_study import TestHand, find_template, generalize_shapes, judge_model, measure_floor
from tracker.evaluation.scan_fit import with_template
from tracker.model.untrained_hand import untrained_hand
from tracker.synthesis.scans.generate import generate_truth


def make_hand(pose: str) -> TestHand:
    truth = generate_truth(33, pose)
    ids = np.random.default_rng(0).integers(0, len(truth.surface), 2000)
    normals = np.zeros((2000, 3))
    return TestHand("s33", pose, truth.surface[ids], normals, truth.vertices, truth.joints)


def test_a_template_of_ones_own_meets_the_registration_it_was_made_from():
    model, hand = untrained_hand("right"), make_hand("flat_together")
    own = with_template(model, find_template(model, hand.vertices))
    errors = judge_model(own, [hand])
    assert errors.vertices[0] < 0.1
    assert judge_model(model, [hand]).vertices[0] > 3.0 * errors.vertices[0]


def test_errors_are_in_mm_and_the_true_vertices_are_near_the_surface():
    model, hand = untrained_hand("right"), make_hand("relaxed")
    errors = judge_model(model, [hand]).summarize()
    assert 0.2 < errors["scan_to_mesh_mm"] < 3.0 and 0.3 < errors["vertices_mm"] < 6.0
    assert 0.05 < measure_floor(model, [hand]) < 0.5


def test_templates_of_few_kinds_are_met_with_as_many_components_by_people_left_out():
    rng = np.random.default_rng(1)
    kinds = rng.normal(size=(3, 20, 3))
    templates = np.einsum("sk,kvi->svi", rng.normal(size=(24, 3)), kinds)
    rows = generalize_shapes(templates, np.repeat(np.arange(12), 2), (0, 1, 2, 3))
    means = [row["mean_mm"] for row in rows]
    assert means[0] > means[1] > means[2] > means[3] and means[3] < 1e-6


def test_a_persons_other_hand_is_left_out_too():
    """Left in, it would explain everything."""
    rng = np.random.default_rng(2)
    templates = np.repeat(rng.normal(size=(4, 10, 3)), 2, axis=0)
    alone = generalize_shapes(templates, np.arange(8), (7,))[0]["mean_mm"]
    together = generalize_shapes(templates, np.repeat(np.arange(4), 2), (7,))[0]["mean_mm"]
    assert alone < 1e-6 < together


def test_drawings_stand_alone():
    rows = [{"components": n, "mean_mm": 1.0 / (n + 1), "sd_mm": 0.1} for n in range(5)]
    drawings = draw_study(
        {
            "compactness": {"pose": [0.5, 0.9, 1.0], "shape": [0.7, 1.0]},
            "pose_space": {"both & <hands>": rows, "right": rows},
            "shape_space": {"people left out": rows},
        }
    )
    assert set(drawings) == {"compactness", "pose_space", "shape_space"}
    for drawing in drawings.values():
        root = ElementTree.fromstring(drawing)
        assert root.tag.endswith("svg") and len(root.findall(".//{*}polyline")) >= 1
