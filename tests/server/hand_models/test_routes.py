"""`/hand-models`."""

from __future__ import annotations

from fastapi.testclient import TestClient


def test_the_default_hands_are_offered_with_ids_that_stay(client: TestClient) -> None:
    right, left, trained, untrained = client.get("/api/v1/hand-models").json()["items"]
    assert (untrained["kind"], untrained["registers"], untrained["has_pose_shapes"]) == ("untrained", True, False)
    assert client.get(f"/api/v1/hand-models/{untrained['id']}").json() == untrained
    assert (trained["kind"], trained["has_pose_shapes"], trained["provenance"]["license"]) == (
        "default",
        True,
        "CC0-1.0",
    )
    assert client.get(f"/api/v1/hand-models/{trained['id']}").json() == trained
    assert (right["side"], left["side"]) == ("right", "left")
    assert right["id"] == client.get("/api/v1/hand-models").json()["items"][0]["id"] != left["id"]
    for model in (right, left):
        assert (len(model["bones"]), model["degrees_of_freedom"]) == (20, 37)
        assert 1200 < model["faces"] < 1800
        assert "size" in model["shape_parameters"]
        assert model["provenance"]
