"""A pair of track and labels is judged once, remembered for a while, and never by half."""

from __future__ import annotations

import hashlib
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from server.database import Database
from server.evaluations import judge as judge_module
from server.evaluations.judge import Judge, Verdict
from server.evaluations.labels import find_current_labels
from tests.server.conftest import MakeRecording
from tests.server.evaluations.known_tracks import Known, store_known


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


@pytest.fixture
def known(database: Database, tmp_path: Path, make_recording: MakeRecording) -> Known:
    known = store_known(database, tmp_path / "files", make_recording)
    known.mark(0, (3.0, 4.0))
    return known


@pytest.fixture
def judge(known: Known) -> Judge:
    return Judge(known.context.storage)


def find(judge: Judge, known: Known) -> Verdict:
    database = known.context.database
    with database.reading() as session:
        labels = find_current_labels(session, known.recording.id)
    return judge.find(database, known.track.id, labels)


def test_errors_are_the_distances_between_marks_and_joints(judge: Judge, known: Known) -> None:
    known.mark(2, (0.0, -6.0))
    verdict = find(judge, known)
    np.testing.assert_allclose(verdict.evaluation.error, np.repeat([[5.0], [6.0]], 21, axis=1), atol=1e-9)
    assert verdict.evaluation.frame.tolist() == [0, 2]
    assert verdict.labels["kind"] == "now" and verdict.labels["items"] == 2
    assert verdict.track_sha256 == hashlib.sha256((known.folder / "track.npz").read_bytes()).hexdigest()
    assert verdict.parameters["terms"] and isinstance(verdict.parameters["iterations"], int)


def test_the_same_pair_is_the_same_verdict_until_the_labels_change(judge: Judge, known: Known) -> None:
    first = find(judge, known)
    assert find(judge, known) is first
    known.mark(1, (1.0, 0.0))
    second = find(judge, known)
    assert second is not first and second.evaluation.statistics.count == 42
    assert find(judge, known) is second


def test_the_verdict_that_was_not_asked_for_longest_is_forgotten_first(
    judge: Judge, known: Known, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(judge_module, "MOST", 2)
    database = known.context.database
    with database.reading() as session:
        first = find_current_labels(session, known.recording.id)
    known.mark(1, (1.0, 0.0))
    with database.reading() as session:
        second = find_current_labels(session, known.recording.id)
    known.mark(2, (1.0, 0.0))
    with database.reading() as session:
        third = find_current_labels(session, known.recording.id)

    def ask(labels: object) -> Verdict:
        return judge.find(database, known.track.id, labels)  # type: ignore[arg-type]

    kept, forgotten = ask(first), ask(second)
    assert ask(first) is kept, "so the second was not asked for longest"
    ask(third)
    assert ask(first) is kept and ask(second) is not forgotten


def test_of_many_who_ask_at_once_all_get_the_one_verdict(judge: Judge, known: Known) -> None:
    with ThreadPoolExecutor(8) as pool:
        verdicts = list(pool.map(lambda _: find(judge, known), range(8)))
    assert all(verdict is verdicts[0] for verdict in verdicts)


def test_a_track_whose_files_are_missing_is_judged_when_they_are_back(judge: Judge, known: Known) -> None:
    away = known.folder.rename(known.folder.with_name("away"))
    for _ in range(2):
        with pytest.raises(Exception, match=r"setup.json|track.npz"):
            find(judge, known)
    away.rename(known.folder)
    assert find(judge, known).evaluation.statistics.mean == pytest.approx(5.0)
