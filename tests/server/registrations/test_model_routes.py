"""`/hand-models/{model_id}/...`: what the browser and other people's software get of a model."""

from __future__ import annotations

import uuid
from pathlib import Path

import numpy as np
from fastapi.testclient import TestClient

from server.hand_models.storing import UNTRAINED_ID, resolve_model
from tests.server.packed_arrays import unpack_arrays
from tracker import load_blend_model, load_mano, mirror_blend, untrained_hand

UNTRAINED = f"/api/v1/hand-models/{UNTRAINED_ID}"


def test_the_browser_gets_the_mesh_that_turns_registrations_the_right_way_up(client: TestClient) -> None:
    arrays, facts = unpack_arrays(client.get(f"{UNTRAINED}/geometry").content)
    model = untrained_hand("right")
    np.testing.assert_allclose(arrays["vertices"], model.template, atol=1e-7)
    np.testing.assert_array_equal(arrays["tips"], model.tips)
    np.testing.assert_allclose(arrays["joints"], model.joints_of(model.template), atol=1e-7)
    assert arrays["shape_directions"].shape == (len(model.template), 3, facts["shape_count"])


def test_a_model_comes_back_as_its_file_and_as_mano_for_either_hand(client: TestClient, tmp_path: Path) -> None:
    state = client.app.state  # pyright: ignore[reportAttributeAccessIssue]
    with state.database.writing() as session:
        resolve_model(session, state.storage, None)
    model = untrained_hand("right")
    (tmp_path / "model.npz").write_bytes(client.get(f"{UNTRAINED}/model.npz").content)
    np.testing.assert_array_equal(load_blend_model(tmp_path / "model.npz").template, model.template)
    for side, expected in (("right", model), ("left", mirror_blend(model))):
        path = tmp_path / f"MANO_{side.upper()}.pkl"
        path.write_bytes(client.get(f"{UNTRAINED}/mano/{side}").content)
        np.testing.assert_allclose(load_mano(path).template, expected.template, atol=1e-12)


def test_a_model_that_is_not_there_or_is_no_blend_model_is_not_found(client: TestClient) -> None:
    default = client.get("/api/v1/hand-models").json()["items"][0]["id"]
    for id_ in (uuid.uuid4(), default):
        for what in ("geometry", "model.npz", "mano/right"):
            assert client.get(f"/api/v1/hand-models/{id_}/{what}").status_code == 404
    assert client.get(f"{UNTRAINED}/mano/both").status_code == 422
