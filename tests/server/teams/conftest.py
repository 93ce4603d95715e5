"""People of a studio, each with a token, and a project with a recording."""

from __future__ import annotations

import uuid
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import pytest
from fastapi.testclient import TestClient

from server.access.models import Account, Role, TokenRow
from server.access.secrets import hash_secret

API = "/api/v1"


@dataclass(frozen=True)
class Person:
    """Somebody who asks the studio."""

    id: str
    name: str
    client: TestClient
    secret: str

    def send(self, method: str, path: str, json: Any = None, revision: int | None = None, **options: Any) -> Any:
        headers = {"Authorization": f"Bearer {self.secret}"} | options.pop("headers", {})
        if revision is not None:
            headers["If-Match"] = f'"{revision}"'
        return self.client.request(method, API + path, json=json, headers=headers, **options)

    def get(self, path: str, **params: Any) -> Any:
        answer = self.send("GET", path, params=params)
        assert answer.status_code == 200, answer.text
        return answer.json()

    def make(self, path: str, **body: Any) -> Any:
        answer = self.send("POST", path, body)
        assert answer.status_code == 201, answer.text
        return answer.json()

    def act(self, assignment: dict[str, Any], act: str, json: Any = None) -> Any:
        """Submit, accept or return an assignment as it is now."""
        now = self.get(f"/assignments/{assignment['id']}")
        answer = self.send("POST", f"/assignments/{assignment['id']}/{act}", json, revision=now["revision"])
        assert answer.status_code == 200, answer.text
        return answer.json()

    def mark(self, sequence: str, frame: int, x: float = 1, replica: str | None = None, hand: str = "right") -> Any:
        """Mark a hand for the first time; the answer as it comes."""
        body = {"points": [[x, 2, 2]] * 21, "operation_id": str(uuid.uuid4())}
        path = f"/sequences/{sequence}/annotations/cam0/{frame}/{hand}"
        params = {} if replica is None else {"replica": replica}
        return self.send("PUT", path, body, headers={"If-None-Match": "*"}, params=params)


Join = Callable[..., Person]


@pytest.fixture
def join(studio: Any) -> Join:
    """Makes an account with a token that may write."""

    def made(name: str, role: Role = "annotator") -> Person:
        account_id, secret = uuid.uuid4(), f"token-of-{name}"
        with studio.database.writing() as session:
            session.add(Account(id=account_id, name=name, role=role))
            session.flush()
            session.add(
                TokenRow(account_id=account_id, name="test", secret_hash=hash_secret("token", secret), may_write=True)
            )
        return Person(str(account_id), name, studio.client, secret)

    return made


@pytest.fixture
def lead(join: Join) -> Person:
    return join("lea", "lead")


@pytest.fixture
def reviewer(join: Join) -> Person:
    return join("rob", "reviewer")


@pytest.fixture
def ann(join: Join) -> Person:
    return join("ann")


@pytest.fixture
def bob(join: Join) -> Person:
    return join("bob")


@dataclass(frozen=True)
class Project:
    """A project with one recording of 12 frames."""

    id: str
    sequence: str
    lead: Person

    def assign(self, person: Person, first: int, last: int, **more: Any) -> dict[str, Any]:
        body = {"sequence_id": self.sequence, "account_id": person.id, "frame_first": first, "frame_last": last}
        return self.lead.make(f"/projects/{self.id}/assignments", **body, **more)

    def replicate(self, people: list[Person], frames: list[int], **more: Any) -> dict[str, Any]:
        body = {"name": "Agreement", "sequence_id": self.sequence, "frames": frames, "cameras": ["cam0"]}
        body |= {"hands": ["right"], "account_ids": [person.id for person in people]}
        return self.lead.make(f"/projects/{self.id}/replica-sets", **(body | more))


@pytest.fixture
def project(lead: Person, add_recording: Any) -> Project:
    sequence = add_recording("waving", frames=12)["id"]
    made = lead.make("/projects", name="Hands in action")
    assert lead.send("PUT", f"/projects/{made['id']}/sequences/{sequence}").status_code == 204
    return Project(made["id"], sequence, lead)
