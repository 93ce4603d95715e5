"""Hands that the detector saw in the whole recording are suggested as they were found, joint by joint."""

from __future__ import annotations

import shutil
import uuid
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from server.access.places import Place
from server.compute import ComputeContext
from server.database import Database
from server.jobs.detections import AREA
from server.storage import Storage
from server.suggestions.detector import suggest_detected
from server.suggestions.schemas import Suggestion
from server.suggestions.service import Recorded
from tests.server.quality.conftest import see
from tracker import Annotation, Annotations
from tracker.detection import DETECTOR_LABEL, RecordedHands

SEQUENCE = uuid.uuid4()


@pytest.fixture
def database_kind() -> str:
    """One will do: nothing is read of it."""
    return "sqlite"


@pytest.fixture
def context(database: Database, tmp_path: Path) -> ComputeContext:
    return ComputeContext(database, Storage(tmp_path / "studio"))


def keep(context: ComputeContext, found: RecordedHands) -> uuid.UUID:
    job_id = uuid.uuid4()
    found.save(context.storage.document(AREA, job_id))
    return job_id


def suggest(context: ComputeContext, job_id: uuid.UUID | None, frame: int = 0, camera: str = "cam0"):
    recorded, place = Recorded(SEQUENCE, "x"), Place(SEQUENCE, camera, frame, "right")
    return suggest_detected(context, recorded, job_id, place)


def test_both_hands_of_an_image_are_suggested_whichever_is_asked_for(context: ComputeContext, rng) -> None:
    marks = {("cam0", 0, hand): rng.uniform(0, 30, (21, 2)).round(2) for hand in ("left", "right")}
    found = suggest(context, keep(context, see(marks, range(2))))
    assert {one.hand for one in found} == {"left", "right"}
    for one in found:
        assert (one.source, one.label, one.camera, one.frame) == ("detector", DETECTOR_LABEL, "cam0", 0)
        assert (one.track_id, one.model) == (None, "")
        np.testing.assert_array_equal([joint.px for joint in one.joints if joint], marks["cam0", 0, one.hand])


def test_a_joint_that_was_not_seen_is_not_suggested_and_a_hidden_one_is_guessed_as_occluded(context, rng) -> None:
    states = np.array([0, 1, 2] * 7)
    points = np.column_stack([rng.uniform(0, 30, (21, 2)), states])
    item = Annotation(0, "cam0", "right", points)
    found = replace(see({}, range(1)), cameras=("cam0",), hands=Annotations((item,)), scores={item.key: 0.9})
    [one] = suggest(context, keep(context, found))
    guesses = [None if joint is None else joint.guess for joint in one.joints]
    assert guesses == [None, "occluded", "visible"] * 7


def test_an_image_that_was_looked_at_in_vain_is_not_looked_at_again(context: ComputeContext, rng) -> None:
    """There is no recording that it could be looked for in."""
    seen = see({("cam0", 0, "right"): rng.uniform(0, 30, (21, 2))}, range(3))
    assert suggest(context, keep(context, seen), frame=2) == []


@pytest.mark.parametrize("where", [{"frame": 1}, {"camera": "cam0"}])
def test_a_camera_without_colour_has_no_hands_whoever_looks(context, make_recording, where) -> None:
    shutil.copytree(make_recording(color=None), context.storage.folder("sequences", SEQUENCE))
    elsewhere = keep(context, replace(see({}, range(1)), cameras=("cam9",)))
    found: list[Suggestion] = [*suggest(context, elsewhere, **where), *suggest(context, None, **where)]
    assert found == []
