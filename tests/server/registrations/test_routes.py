"""`/registrations`."""

from __future__ import annotations

import uuid

import numpy as np

from tests.server.curation import API, Curation, curation, join
from tests.server.packed_arrays import unpack_arrays

__all__ = ["curation", "join"]


def test_the_browser_gets_the_mesh_and_the_error_of_each_point_it_draws(curation: Curation) -> None:
    id_ = curation.register("a")
    found = curation.look(curation.rob, id_)
    address = f"{API}/registrations/{id_}/geometry"
    arrays, facts = unpack_arrays(curation.studio.client.get(address, params={"size": 500}).content)
    assert facts == {"side": "right"}
    np.testing.assert_allclose(arrays["vertices"], curation.hand.found.vertices, atol=1e-7)
    np.testing.assert_array_equal(arrays["faces"], curation.hand.found.faces)
    seen = np.isfinite(arrays["vertex_error_mm"])
    assert 0.5 < seen.mean() <= 1.0
    scan = found["scan"]
    points_at = f"{API}/scans/{scan['id']}/geometry/{scan['geometry_key']}"
    points, scale = unpack_arrays(curation.studio.client.get(points_at, params={"size": 500}).content)
    drawn = np.array(scale["origin_m"]) + np.array(scale["step_m"]) * points["positions"]
    whole, distances = curation.hand.scan.points, 1e3 * curation.hand.found.scan_to_mesh
    nearest = np.linalg.norm(drawn[:, None] - whole[None], axis=2).argmin(axis=1)
    np.testing.assert_allclose(arrays["point_error_mm"], distances[nearest], atol=0.02)


def test_of_each_scan_the_newest_registration_is_listed_unless_one_asks_for_all(curation: Curation) -> None:
    first = curation.register("a", 0.9)
    scan_id = uuid.UUID(curation.look(curation.rob, first)["scan"]["id"])
    second = curation.register("a", 0.1, scan_id=scan_id)
    listed = curation.rob.get("/registrations")["items"]
    assert [item["id"] for item in listed] == [str(second)]
    assert {item["id"] for item in curation.rob.get("/registrations", all_rounds=True)["items"]} == {
        str(first),
        str(second),
    }
    scan = curation.rob.get(f"/scans/{scan_id}")
    assert (scan["state"], scan["registration"]["id"]) == ("registered", str(second))


def test_registrations_are_filtered(curation: Curation) -> None:
    curation.register("a", subject="Ada", collection="x")
    curation.register("b", subject="Bob", collection="y", verdict="bad", score=0.9)
    assert curation.queue(curation.rob, subject="Ada") == ["a"]
    assert curation.queue(curation.rob, collection="y") == ["b"]
    assert curation.queue(curation.rob, verdict="bad") == ["b"]
    assert curation.queue(curation.rob, queue="flagged") == ["b"]
    assert curation.queue(curation.rob, round=2) == []
    for cursor in ("AAAA", "WzEsMl0", "WyJub3ciLCAieCJd", "WzAuNSwgIngiXQ"):
        for order in ("newest", "likely_failures"):
            answer = curation.rob.send("GET", "/registrations", params={"cursor": cursor, "order": order})
            assert answer.status_code == 404, answer.text


def test_the_file_is_the_one_that_was_written(curation: Curation) -> None:
    id_ = curation.register("a")
    answer = curation.studio.client.get(f"{API}/registrations/{id_}/registration.npz")
    assert answer.content == (curation.hand.folder / "registration.npz").read_bytes()
