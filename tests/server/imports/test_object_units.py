"""The unit of an object's mesh is said, or shown as a guess, before a recording is stored; then it is the one used."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from tests.server.conftest import Studio
from tests.server.imports.test_routes import parts_of, upload
from tracker import load_sequence
from tracker.model import load_model

API = "/api/v1"


def write_recording(folder: Path, side: float, **of_object: Any) -> Path:
    """A recording with a cube of this side, in the file's unit."""
    (folder / "objects").mkdir()
    (folder / "objects" / "cube.ply").write_bytes(trimesh.creation.box((side, side, side)).export(file_type="ply"))
    document = json.loads((folder / "sequence.json").read_text())
    document["objects"] = [{"name": "cube", "model": "objects/cube.ply"} | of_object]
    (folder / "sequence.json").write_text(json.dumps(document))
    return folder


def confirm(studio: Studio, found: dict[str, Any]) -> Path:
    made = studio.client.post(f"{API}/imports/{found['id']}/confirm", json={"name": "cube"})
    assert made.status_code == 201, made.text
    return studio.settings.data_dir / "sequences" / made.json()["id"]


def measure_tracked(recording: Path) -> float:
    """Side of the cube that a track would fit, m."""
    sequence = load_sequence(recording)
    [item] = sequence.objects
    cube = load_model(sequence.object_path(item.name), metres_per_unit=item.metres_per_unit)
    return float(np.ptp(cube.vertices, axis=0)[0])


def test_a_guessed_unit_is_shown_with_the_size_and_another_can_be_chosen(studio: Studio, make_recording) -> None:
    found = upload(studio.client, parts_of(write_recording(make_recording(), 6.0))).json()
    [told] = found["report"]["object_sizes"]
    # A cube of 6 cm, in centimetres: the guess makes 6 mm of it, which nobody saw before.
    assert told == {"name": "cube", "size_m": [0.006] * 3, "metres_per_unit": 0.001, "is_guessed": True}
    [question] = found["report"]["questions"]
    assert (question["field"], question["proposal"], question["is_required"]) == ("object_unit_m", 0.001, False)
    assert [choice["label"] for choice in question["choices"]] == [
        "Millimetres: cube is 0.6 x 0.6 x 0.6 cm",
        "Centimetres: cube is 6 x 6 x 6 cm",
    ]
    assert "0.6 x 0.6 x 0.6 cm" in " ".join(found["report"]["warnings"])
    assert found["report"]["takes"] == ["object_unit_m"]

    again = studio.client.post(f"{API}/imports/{found['id']}/check", json={"options": {"object_unit_m": 0.01}}).json()
    [told] = again["report"]["object_sizes"]
    assert told["size_m"] == pytest.approx([0.06] * 3) and not told["is_guessed"]
    recording = confirm(studio, again)
    assert json.loads((recording / "sequence.json").read_text())["objects"][0]["metres_per_unit"] == 0.01
    assert measure_tracked(recording) == pytest.approx(0.06)


def test_a_guess_that_nobody_changed_is_stored_as_it_was_shown(studio: Studio, make_recording) -> None:
    found = upload(studio.client, parts_of(write_recording(make_recording(), 60.0))).json()
    assert found["report"]["object_sizes"][0]["size_m"] == pytest.approx([0.06] * 3)
    assert measure_tracked(confirm(studio, found)) == pytest.approx(0.06)


@pytest.mark.parametrize("unit", [1.0, 1e-6])
def test_an_impossible_size_is_refused(studio: Studio, make_recording, unit: float) -> None:
    parts = parts_of(write_recording(make_recording(), 60.0))
    found = upload(studio.client, parts, object_unit_m=unit).json()
    assert found["state"] == "refused"
    [problem] = found["report"]["problems"]
    assert "m across; needed 1 mm to 10 m" in problem
    assert found["report"]["questions"][0]["is_required"]


def test_a_mesh_of_no_usual_unit_waits_until_its_unit_is_said(studio: Studio, make_recording) -> None:
    found = upload(studio.client, parts_of(write_recording(make_recording(), 5e5))).json()
    assert found["state"] == "refused" and "no usual unit" in found["report"]["problems"][0]
    again = studio.client.post(f"{API}/imports/{found['id']}/check", json={"options": {"object_unit_m": 1e-6}}).json()
    # A micrometre is no unit of the list, and it may be said all the same: the cube is half a metre.
    assert again["report"]["ok"] and again["report"]["object_sizes"][0]["size_m"] == pytest.approx([0.5] * 3)


def test_what_the_recording_says_wins_and_is_not_asked(studio: Studio, make_recording) -> None:
    folder = write_recording(make_recording(), 60.0, metres_per_unit=0.002)
    found = upload(studio.client, parts_of(folder)).json()
    [told] = found["report"]["object_sizes"]
    assert told["size_m"] == pytest.approx([0.12] * 3) and not told["is_guessed"]
    assert found["report"]["questions"] == [] and found["report"]["takes"] == []
    assert measure_tracked(confirm(studio, found)) == pytest.approx(0.12)


def test_a_mesh_that_cannot_be_read_is_known_before_anything_is_stored(studio: Studio, make_recording) -> None:
    folder = write_recording(make_recording(), 60.0)
    (folder / "objects" / "cube.ply").write_bytes(b"ply\nnothing of the kind")
    found = upload(studio.client, parts_of(folder)).json()
    assert found["state"] == "refused" and "cube" in found["report"]["problems"][0]
    assert str(studio.settings.data_dir) not in json.dumps(found["report"])
