"""Many annotators at once, as the browser behaves: every gesture is a save, sent again until it is acknowledged."""

from __future__ import annotations

import asyncio
import random
import time
import uuid
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import httpx

JOINTS = 21
SHARED_PART, DOUBLED_PART, SHARED_FRAMES = 0.1, 0.02, 5
"""Of the gestures: those on frames that everybody works on, and those whose request is sent twice at once."""

RETRY_SECONDS, REQUEST_SECONDS = 0.25, 30.0


@dataclass(frozen=True)
class Acknowledged:
    """A gesture that the studio said it stored."""

    place: str
    operation_id: str
    revision: int
    points: list[Any]


@dataclass
class Ledger:
    """What the annotators know.

    Attributes:
        acknowledged: In the order of the answers.
        sent: Every operation that ever left, by id, with its place.
        seconds: From sending to answer, of requests that were answered at once.
        resent: Requests that got no answer and were sent again.
        conflicts: Saves that came after somebody else's; merged and sent as another operation.
        doubled: Requests that were sent twice at once.
    """

    acknowledged: list[Acknowledged] = field(default_factory=list)
    sent: dict[str, str] = field(default_factory=dict)
    seconds: list[float] = field(default_factory=list)
    resent: int = 0
    conflicts: int = 0
    doubled: int = 0


@dataclass
class SimulatedAnnotator:
    """One person: goes to a frame, marks joints of its right hand one after the other, goes on.

    Args:
        base: Address of the recording's annotations, up to the frame.
        own: Frames nobody else works on.
        shared: Frames that everybody works on.
        pause: Mean time between two gestures, s.
    """

    client: httpx.AsyncClient
    base: str
    own: Sequence[int]
    shared: Sequence[int]
    pause: float
    ledger: Ledger
    chance: random.Random

    async def work(self, until: float) -> None:
        """Annotate until a moment of `time.monotonic`."""
        await asyncio.sleep(self.chance.uniform(0, self.pause))
        while time.monotonic() < until:
            frames = self.shared if self.chance.random() < SHARED_PART else self.own
            place = f"{self.base}/{self.chance.choice(frames)}/right"
            points, revision = await self._look(place)
            for joint in self.chance.sample(range(JOINTS), 5):
                if time.monotonic() >= until:
                    return
                points[joint] = [round(self.chance.uniform(0, 60), 2), round(self.chance.uniform(0, 40), 2), 2]
                points, revision = await self._save(place, points, joint, revision)
                await asyncio.sleep(self.chance.expovariate(1 / self.pause))

    async def _look(self, place: str) -> tuple[list[Any], int | None]:
        answer, _ = await self._send("GET", place)
        if answer.status_code == 404:
            return [[0.0, 0.0, 0] for _ in range(JOINTS)], None
        answer.raise_for_status()
        return answer.json()["points"], answer.json()["revision"]

    async def _save(
        self, place: str, points: list[Any], joint: int, revision: int | None
    ) -> tuple[list[Any], int | None]:
        """Store the points; where somebody was first, put the joint into theirs and store that."""
        while True:
            operation = str(uuid.UUID(int=self.chance.getrandbits(128), version=4))
            self.ledger.sent[operation] = place
            request: dict[str, Any] = {
                "json": {"points": points, "operation_id": operation},
                "headers": {"If-None-Match": "*"} if revision is None else {"If-Match": f'"{revision}"'},
            }
            answers = [self._send("PUT", place, **request)]
            if self.chance.random() < DOUBLED_PART:
                self.ledger.doubled += 1
                answers.append(self._send("PUT", place, **request))
            told = await asyncio.gather(*answers)
            for answer, seconds in told:
                if seconds is not None:
                    self.ledger.seconds.append(seconds)
                if answer.status_code == 200:
                    self.ledger.acknowledged.append(Acknowledged(place, operation, answer.json()["revision"], points))
            answer = told[0][0]
            if answer.status_code == 200:
                return [list(point) for point in points], answer.json()["revision"]
            if answer.status_code != 409:
                raise RuntimeError(f"PUT {place}: {answer.status_code} {answer.text}")
            self.ledger.conflicts += 1
            theirs = answer.json()["theirs"]
            merged = [[0.0, 0.0, 0] for _ in range(JOINTS)] if theirs is None else theirs["points"]
            merged[joint] = points[joint]
            points, revision = merged, None if theirs is None else theirs["revision"]

    async def _send(self, method: str, place: str, **request: Any) -> tuple[httpx.Response, float | None]:
        """The answer, and how long it took; None where it had to be sent again."""
        tries = 0
        while True:
            began = time.perf_counter()
            try:
                answer = await self.client.request(method, place, **request)
            except httpx.TransportError:
                answer = None
            if answer is not None and answer.status_code < 500:
                return answer, None if tries else time.perf_counter() - began
            tries += 1
            if method == "PUT":
                self.ledger.resent += 1
            await asyncio.sleep(RETRY_SECONDS)


async def annotate_together(
    url: str, base: str, frame_count: int, annotators: int, seconds: float, pause: float, seed: int = 0
) -> Ledger:
    """Have this many people annotate a camera, whose annotations are at `base`; gives what they know then."""
    ledger = Ledger()
    limits = httpx.Limits(max_connections=annotators * 2, max_keepalive_connections=annotators * 2)
    async with httpx.AsyncClient(base_url=f"{url}/api/v1", timeout=REQUEST_SECONDS, limits=limits) as client:
        shared = range(min(SHARED_FRAMES, frame_count))
        each = max(1, (frame_count - len(shared)) // annotators)
        people = [
            SimulatedAnnotator(
                client,
                base,
                range(len(shared) + n * each, len(shared) + (n + 1) * each),
                shared,
                pause,
                ledger,
                random.Random(seed * 1000 + n),
            )
            for n in range(annotators)
        ]
        until = time.monotonic() + seconds
        await asyncio.gather(*(person.work(until) for person in people))
    return ledger


def find_faults(url: str, ledger: Ledger) -> list[str]:
    """What the studio's history of every place that was touched says against what was acknowledged; empty when right.

    Every acknowledged gesture must be in the history once, with its points and its revision; revisions count from 1
    without a gap; and of the operations that were sent none may have been stored twice.
    """
    faults: list[str] = []
    stored: dict[str, tuple[int, Any]] = {}
    with httpx.Client(base_url=f"{url}/api/v1", timeout=REQUEST_SECONDS) as client:
        for place in sorted(set(ledger.sent.values())):
            answer = client.get(f"{place}/history")
            history = answer.json()["items"] if answer.status_code == 200 else []
            revisions = [item["revision"] for item in reversed(history)]
            if revisions != list(range(1, len(revisions) + 1)):
                faults.append(f"{place}: revisions {revisions}")
            stored |= {item["operation_id"]: (item["revision"], item["points"]) for item in history}
            for operation, times in Counter(item["operation_id"] for item in history).items():
                if times > 1:
                    faults.append(f"{place}: {operation} was stored {times} times")
    for gesture in ledger.acknowledged:
        if stored.get(gesture.operation_id) != (gesture.revision, gesture.points):
            faults.append(f"{gesture.place}: {gesture.operation_id} was acknowledged as {gesture.revision} and is lost")
    return faults
