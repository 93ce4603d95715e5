"""Simulated annotators behave as the browser does, and what they were told is held against what was stored."""

from __future__ import annotations

import asyncio
import random
import time
import uuid
from typing import Any

import httpx
import pytest

from server.cli import simulated_annotators
from server.cli.simulated_annotators import (
    Acknowledged,
    Ledger,
    SimulatedAnnotator,
    annotate_together,
    find_faults,
)
from server.client import Studio as Remote
from tests.server.client.conftest import remote

__all__ = ["remote"]

PLACE = "/sequences/s/annotations/cam0/3/right"


@pytest.fixture
def database_kind() -> str:
    return "sqlite"


class BadConnection(httpx.AsyncBaseTransport):
    """Every third answer to a save is lost after the studio gave it, every fifth is that of a broken proxy."""

    def __init__(self) -> None:
        self.real = httpx.AsyncHTTPTransport()
        self.saves = 0

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        answer = await self.real.handle_async_request(request)
        if request.method != "PUT":
            return answer
        await answer.aread()
        self.saves += 1
        if self.saves % 3 == 0:
            raise httpx.ReadError("cut")
        return httpx.Response(502) if self.saves % 5 == 0 else answer


class Overtaken(httpx.AsyncBaseTransport):
    """Before the first save arrives, somebody else stores this hand there."""

    points = [[5.0, 6.0, 1]] * 21

    def __init__(self) -> None:
        self.real = httpx.AsyncHTTPTransport()
        self.is_over = False

    async def handle_async_request(self, request: httpx.Request) -> httpx.Response:
        if request.method == "PUT" and not self.is_over:
            self.is_over = True
            body = {"points": self.points, "operation_id": str(uuid.uuid4())}
            theirs = httpx.Request("PUT", request.url, json=body, headers={"If-None-Match": "*"})
            assert (await self.real.handle_async_request(theirs)).status_code == 200
        return await self.real.handle_async_request(request)


def find_address(remote: Remote) -> str:
    return str(remote.link._client.base_url).partition("/api/")[0]


def test_of_many_at_once_every_gesture_is_stored_once(remote: Remote, add_recording) -> None:
    base = f"/sequences/{add_recording(frames=12)['id']}/annotations/cam0"
    address = find_address(remote)
    ledger, rounds = Ledger(), iter(range(50))
    while not ledger.acknowledged:  # on a busy machine the first look takes longer than that
        work = annotate_together(address, base, 12, annotators=3, seconds=0.3, pause=0.02, seed=next(rounds))
        ledger = asyncio.run(work)
    assert find_faults(address, ledger) == []
    assert ledger.resent == 0 and len(ledger.seconds) >= len(ledger.acknowledged)
    frames = {place.split("/")[-2] for place in ledger.sent.values()}
    assert frames <= {str(frame) for frame in range(11)}, "five that are shared and two of each one's own"
    lost = Acknowledged(ledger.acknowledged[0].place, "never-sent", 1, [])
    assert find_faults(address, Ledger([lost], ledger.sent)) == [
        f"{lost.place}: never-sent was acknowledged as 1 and is lost"
    ]


def test_two_on_one_hand_over_a_bad_connection_send_again_merge_and_lose_nothing(
    remote: Remote, add_recording, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(simulated_annotators, "RETRY_SECONDS", 0.01)
    base = f"/sequences/{add_recording()['id']}/annotations/cam0"
    address, ledger = find_address(remote), Ledger()

    async def work() -> None:
        async with httpx.AsyncClient(base_url=f"{address}/api/v1", transport=BadConnection()) as client:
            people = [SimulatedAnnotator(client, base, [0], [0], 0.005, ledger, random.Random(seed)) for seed in (1, 2)]
            until = time.monotonic() + 0.6
            await asyncio.gather(*(person.work(until) for person in people))

    asyncio.run(work())
    assert ledger.resent > 0 and ledger.conflicts > 0 and ledger.acknowledged
    assert find_faults(address, ledger) == []


def test_who_comes_second_puts_the_one_joint_into_the_others_hand(remote: Remote, add_recording) -> None:
    sequence = add_recording()["id"]
    base, address, ledger = f"/sequences/{sequence}/annotations/cam0", find_address(remote), Ledger()

    async def work() -> None:
        async with httpx.AsyncClient(base_url=f"{address}/api/v1", transport=Overtaken()) as client:
            person = SimulatedAnnotator(client, base, [1], [1], 0.005, ledger, random.Random(3))
            ends = time.monotonic() + 60
            while not ledger.acknowledged:
                assert time.monotonic() < ends, "waited in vain"
                await person.work(time.monotonic() + 0.1)

    asyncio.run(work())
    assert ledger.conflicts == 1 and ledger.acknowledged[0].revision == 2
    first = ledger.acknowledged[0].points
    assert sum(point != theirs for point, theirs in zip(first, Overtaken.points, strict=True)) == 1
    assert find_faults(address, ledger) == [], "what is in the history is what was acknowledged"


def test_a_refusal_that_no_merging_mends_ends_the_work_with_its_words(remote: Remote, add_recording) -> None:
    base, address = f"/sequences/{add_recording()['id']}/annotations/cam0", find_address(remote)

    async def work() -> None:
        async with httpx.AsyncClient(base_url=f"{address}/api/v1") as client:
            person = SimulatedAnnotator(client, base, [99], [99], 0.001, Ledger(), random.Random(0))
            await person.work(time.monotonic() + 10.0)

    with pytest.raises(RuntimeError, match=r"PUT .*/99/right: 404 .*has no frame 99; they go from 0 to 2"):
        asyncio.run(work())


def answer_with(monkeypatch: pytest.MonkeyPatch, history: list[dict[str, Any]]) -> None:
    """Has every history be this one, as a studio that is wrong would answer."""
    monkeypatch.setattr(httpx.Client, "get", lambda *_: httpx.Response(200, json={"items": history}))


def test_what_was_acknowledged_and_is_not_there_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check itself must be able to fail."""
    answer_with(
        monkeypatch,
        [
            {"revision": 3, "operation_id": "b", "points": [[2.0, 2.0, 2]]},
            {"revision": 1, "operation_id": "a", "points": [[1.0, 1.0, 2]]},
        ],
    )
    ledger = Ledger(
        acknowledged=[
            Acknowledged(PLACE, "a", 1, [[1.0, 1.0, 2]]),
            Acknowledged(PLACE, "b", 3, [[9.0, 9.0, 2]]),
            Acknowledged(PLACE, "c", 2, [[5.0, 5.0, 2]]),
        ],
        sent={"a": PLACE, "b": PLACE, "c": PLACE},
    )
    assert find_faults("http://127.0.0.1:1", ledger) == [
        f"{PLACE}: revisions [1, 3]",
        f"{PLACE}: b was acknowledged as 3 and is lost",
        f"{PLACE}: c was acknowledged as 2 and is lost",
    ]


def test_a_gesture_that_was_stored_twice_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    points = [[1.0, 1.0, 2]]
    answer_with(monkeypatch, [{"revision": n, "operation_id": "a", "points": points} for n in (2, 1)])
    assert f"{PLACE}: a was stored 2 times" in find_faults("http://127.0.0.1:1", Ledger(sent={"a": PLACE}))
