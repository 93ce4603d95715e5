"""Hand models as files: sent, given out, and never run."""

from __future__ import annotations

import os
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.server.conftest import Studio
from tracker import load_blend_model, load_mano, save_blend_model, save_mano, untrained_hand

API = "/api/v1"


def upload(studio: Studio, file: str, data: bytes, **fields: str) -> Any:
    return studio.client.post(f"{API}/hand-models", files={"files": (file, data)}, data=fields)


@pytest.mark.parametrize("name", ["hand.npz", "MANO_RIGHT.npz", "MANO_RIGHT.pkl"])
def test_a_model_comes_in_as_it_goes_out(studio: Studio, tmp_path: Path, name: str) -> None:
    model = untrained_hand("right")
    (save_blend_model if name == "hand.npz" else save_mano)(model, tmp_path / name)
    answer = upload(studio, name, (tmp_path / name).read_bytes(), name="My hand")
    assert answer.status_code == 201, answer.text
    made = answer.json()
    assert (made["kind"], made["name"], made["side"], made["registers"]) == ("uploaded", "My hand", "right", True)
    assert made["vertices"] == len(model.template) and made["degrees_of_freedom"] == 51
    assert made in studio.client.get(f"{API}/hand-models").json()["items"]
    given = {"model.npz": "model.npz", "MANO_RIGHT.pkl": "mano/right", "MANO_LEFT.pkl": "mano/left"}
    for file, address in given.items():
        answer = studio.client.get(f"{API}/hand-models/{made['id']}/{address}")
        assert answer.status_code == 200, answer.text
        (tmp_path / file).write_bytes(answer.content)
    back = load_blend_model(tmp_path / "model.npz")
    np.testing.assert_allclose(back.template, model.template, atol=1e-9)
    right, left = load_mano(tmp_path / "MANO_RIGHT.pkl"), load_mano(tmp_path / "MANO_LEFT.pkl")
    assert (right.side, left.side) == ("right", "left")
    shape = np.ones(model.num_shape)
    flip = np.array([1.0, -1.0, 1.0])
    np.testing.assert_allclose(left.shaped(shape), right.shaped(shape) * flip, atol=1e-9)


class Evil:
    def __reduce__(self) -> tuple[Any, tuple[str]]:
        return os.system, (f"touch {self.path}",)

    def __init__(self, path: Path) -> None:
        self.path = path


def test_a_hostile_pickle_runs_nothing_and_is_refused(studio: Studio, tmp_path: Path) -> None:
    trap = tmp_path / "ran"
    for data in (pickle.dumps(Evil(trap)), pickle.dumps({"v_template": Evil(trap)}, protocol=2)):
        answer = upload(studio, "MANO_RIGHT.pkl", data)
        assert answer.status_code == 422 and str(studio.settings.data_dir) not in answer.text, answer.text
    assert not trap.exists()
    for name, data in (("a.npz", b"PK junk"), ("a.pkl", b""), ("a.txt", b"hello"), ("a.npz", b"")):
        assert upload(studio, name, data).status_code == 422, name
    assert not (studio.settings.data_dir / "models").exists()


def test_a_file_that_was_changed_is_not_given_out(studio: Studio, tmp_path: Path) -> None:
    save_blend_model(untrained_hand("right"), tmp_path / "a.npz")
    made = upload(studio, "a.npz", (tmp_path / "a.npz").read_bytes()).json()
    path = studio.settings.data_dir / "models" / made["id"] / "model.npz"
    path.write_bytes(path.read_bytes() + b"x")
    assert studio.client.get(f"{API}/hand-models/{made['id']}/model.npz").status_code == 409


def test_a_deleted_model_comes_back_and_one_that_was_not_trained_has_no_report(studio: Studio, tmp_path: Path) -> None:
    save_blend_model(untrained_hand("right"), tmp_path / "a.npz")
    made = upload(studio, "a.npz", (tmp_path / "a.npz").read_bytes()).json()
    address = f"{API}/hand-models/{made['id']}"
    assert studio.client.get(f"{address}/report").status_code == 404
    assert studio.client.delete(address).status_code == 204
    assert studio.client.get(address).status_code == 404
    assert studio.client.post(f"{address}/restore").json() == made
