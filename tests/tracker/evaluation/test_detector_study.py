"""A detector judged on images whose fingertips are known."""

from dataclasses import replace

import numpy as np
import pytest

from tracker.detection.annotated_images import annotated_images
from tracker.detection.default_detector import default_detector
from tracker.evaluation.detector_study import judge_detector, judge_image
from tracker.synthesis.fingertip_images import render_fingertip_images
from tracker.synthesis.random_hands import RandomHands

EASY = RandomHands(two_hands=0.0, thing=0.0, any_side=0.0, farthest=0.5, small_camera=0.0)


@pytest.fixture(scope="module")
def images():
    return list(render_fingertip_images(12, 99, EASY))


def test_the_detector_that_comes_along_finds_fingertips_it_never_saw(images):
    curve = judge_detector(default_detector(), images)
    assert curve.num_images == len(images)
    assert curve.num_truths == sum(int(item.is_visible.sum()) for item in images)
    assert curve.auc > 0.45


def test_boxes_of_another_place_count_as_wrong(images):
    item = images[0]
    shifted = replace(item, tips=item.tips + 300.0)
    judged = judge_image(default_detector(), shifted)
    assert not judged.is_true.any()
    assert judged.num_truths == int(item.is_visible.sum())


@pytest.mark.slow
@pytest.mark.shared_data
def test_on_twins_of_real_motions_the_area_is_beyond_the_bar(shared_data, tmp_path):
    """The bar is 0.55; the detector has seen neither these motions nor these hands."""
    from tracker.capture.annotations import load_annotations
    from tracker.model import save_model
    from tracker.synthesis.recording import RecordingOptions, write_recording
    from tracker.synthesis.twin import load_twin

    judged = []
    for sequence, step in (("04", 40), ("09", 40), ("20", 50)):
        twin = load_twin(shared_data / "ijcv16", sequence, 1500)
        recorded = write_recording(
            twin, tmp_path / sequence, RecordingOptions(range(5, twin.num_moments, step), seed=8), save_model
        )
        marked = load_annotations(tmp_path / sequence / "annotations.json")
        judged += list(annotated_images(recorded, marked))
    curve = judge_detector(default_detector(), judged)
    assert curve.num_truths > 50
    assert curve.auc > 0.75
    assert np.all(np.diff(curve.recall) >= 0)
