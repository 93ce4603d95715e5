"""Scans and decisions from a script."""

from __future__ import annotations

import zipfile
from pathlib import Path

import pytest

from server.client import Studio as Remote
from server.client import StudioRefusal
from tests.server.client.conftest import lose_first_answers
from tests.server.conftest import GeneratedHand, Studio
from tests.server.curation import add_registered


def test_scans_go_in_and_training_sets_and_models_come_out(
    remote: Remote, studio: Studio, generated_hand: GeneratedHand, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    curation = remote.curation
    sent = curation.upload([generated_hand.folder / "hand.ply"], collection="Lab", subject="Ada")
    assert [item["name"] for item in sent["added"]] == ["hand"]
    assert len(curation.upload([generated_hand.folder / "hand.ply"], collection="Lab")["known"]) == 1
    assert [scan["subject"] for scan in curation.scans(collection="Lab")] == ["Ada"]
    job = remote.jobs.register(collection="Lab")
    assert (job["kind"], job["state"]) == ("register", "queued")
    add_registered(studio.app, generated_hand, "done")
    [registration] = curation.registrations(queue="undecided")
    lose_first_answers(remote, monkeypatch, 2)
    done = curation.decide(registration["id"], "reject", ["finger_off"])
    monkeypatch.undo()
    assert done["decision"]["number"] == 1, "sent three times, done once"
    curation.undo(done["decision"]["id"])
    curation.decide(registration["id"], "accept")
    chosen = curation.make_training_set("set", by="decisions")
    with zipfile.ZipFile(curation.download_training_set(chosen["id"], tmp_path / "set.zip")) as archive:
        assert f"{registration['id']}/registration.npz" in archive.namelist()
    found = curation.download_registration(registration["id"], tmp_path / "a.npz")
    assert found.read_bytes() == (generated_hand.folder / "registration.npz").read_bytes()
    [untrained] = [model for model in curation.hand_models() if model["kind"] == "untrained"]
    assert curation.download_hand_model(untrained["id"], tmp_path / "MANO_LEFT.pkl").stat().st_size > 10_000
    with pytest.raises(StudioRefusal):
        remote.jobs.train(chosen["id"], "")
    with pytest.raises(StudioRefusal, match="a model needs 20 of at least 2 people"):
        remote.jobs.loop("hand", by="decisions")
