"""Tracks against annotations, over REST."""

from __future__ import annotations

from fastapi.testclient import TestClient

from tests.server.conftest import Tracked

API = "/api/v1"


def test_a_track_is_evaluated_against_the_annotations_as_they_are_now(client: TestClient, tracked: Tracked) -> None:
    address = f"{API}/tracks/{tracked.track_id}"
    result = client.get(f"{address}/evaluation").json()
    assert result["evaluated"] == 12
    assert result["joint_error_px"]["mean"] < 3.0
    assert result["joints"][0]["joint"] == "wrist"
    assert client.get(address).json()["error_px"] == result["joint_error_px"]["mean"]
    place = f"{API}/sequences/{tracked.sequence_id}/annotations/cam0/3/right"
    revision = client.get(place).headers["etag"]
    assert client.delete(place, headers={"If-Match": revision}).status_code in (200, 204)
    assert client.get(f"{address}/evaluation").json()["evaluated"] == 11
