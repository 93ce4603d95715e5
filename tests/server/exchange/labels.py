"""Hands to put into a studio."""

from __future__ import annotations

import json
import uuid
from typing import Any

from fastapi.testclient import TestClient

API = "/api/v1"


def make_points(x: float = 10.0, v: int = 2) -> list[list[float]]:
    """21 joints in a row, inside an image of 32x24 px."""
    return [[x + 0.25 * joint, 5.0 + 0.5 * joint, v] for joint in range(21)]


def put(client: TestClient, sequence: dict[str, Any], frame: int, points: Any, hand: str = "right") -> dict[str, Any]:
    """Mark a hand, whatever is there."""
    address = f"{API}/sequences/{sequence['id']}/annotations/cam0/{frame}/{hand}"
    now = client.get(address)
    headers = {"If-Match": now.headers["ETag"]} if now.is_success else {"If-None-Match": "*"}
    body = {"points": points, "operation_id": str(uuid.uuid4())}
    answer = client.put(address, json=body, headers=headers)
    assert answer.is_success, answer.text
    return answer.json()


def get_labels(client: TestClient, sequence: dict[str, Any]) -> dict[tuple[int, str], Any]:
    """Points by frame and hand."""
    items = client.get(f"{API}/sequences/{sequence['id']}/annotations").json()["items"]
    return {(item["frame"], item["hand"]): item["points"] for item in items}


def send(client: TestClient, address: str, files: dict[str, bytes], **fields: Any) -> Any:
    """Upload files with a form's fields; options as JSON."""
    data = {name: json.dumps(value) if name == "options" else value for name, value in fields.items()}
    return client.post(
        f"{API}{address}", files=[("files", (name, content)) for name, content in files.items()], data=data
    )


def take_in(client: TestClient, address: str, files: dict[str, bytes], policy: str, **fields: Any) -> Any:
    """Have files looked at, then import them as the report says."""
    report = send(client, f"{address}/check", files, **fields)
    assert report.is_success, report.text
    assert report.json()["check"], report.json()["problems"]
    return send(client, f"{address}/import", files, policy=policy, check=report.json()["check"], **fields)
