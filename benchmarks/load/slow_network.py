"""A network between browsers and the studio: every request is late by another time, and some never arrive."""

from __future__ import annotations

import asyncio
import contextlib
import random
import time
from dataclasses import dataclass, field

import h11
import httpx

HOP_BY_HOP = {b"connection", b"keep-alive", b"transfer-encoding", b"upgrade", b"te", b"trailer"}
"""Headers that belong to one connection (RFC 9110, 7.6.1) and are not passed on."""

CHUNK = 65536


class Cut(Exception):
    """The connection breaks here."""


@dataclass(frozen=True)
class Answered:
    """A request that the studio answered.

    Attributes:
        method: Such as `PUT`.
        path: Without the query.
        status: Of the answer.
        seconds: The studio's own time: from handing it the whole request to its whole answer.
        at: When it was answered, s of `time.monotonic`.
    """

    method: str
    path: str
    status: int
    seconds: float
    at: float


@dataclass
class SlowNetwork:
    """A proxy on a free port of this machine.

    Args:
        upstream: Address of the studio.
        latency: Each request is late by a time between 0 and this, drawn anew, s: partly on its way, partly its answer.
        cut_part: Of the requests to the API: half of these never reach it, the others' answers never come back.
        chance: Draws them.
    """

    upstream: str
    latency: float
    cut_part: float
    chance: random.Random
    answered: list[Answered] = field(default_factory=list)
    cuts: int = 0
    is_down: bool = False
    mended: list[float] = field(default_factory=list)
    _connections: set[asyncio.StreamWriter] = field(default_factory=set)
    _tasks: set[asyncio.Task[None]] = field(default_factory=set)

    async def __aenter__(self) -> SlowNetwork:
        limits = httpx.Limits(max_connections=None, max_keepalive_connections=50)
        self._client = httpx.AsyncClient(base_url=self.upstream, timeout=60, limits=limits)
        self._server = await asyncio.start_server(self._take, "127.0.0.1", 0)
        return self

    async def __aexit__(self, *_: object) -> None:
        self._server.close()
        self.is_down = True
        self.cut_all()
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._client.aclose()

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.sockets[0].getsockname()[1]}"

    def cut_all(self) -> None:
        """Break every connection there is."""
        for writer in list(self._connections):
            writer.transport.abort()

    async def go_down(self, seconds: float) -> None:
        """Nothing passes for so long."""
        self.is_down = True
        self.cut_all()
        await asyncio.sleep(seconds)
        self.is_down = False
        self.mended.append(time.monotonic())

    def _take(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = asyncio.create_task(self._serve(reader, writer))
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        connection = h11.Connection(h11.SERVER)
        self._connections.add(writer)
        try:
            while (found := await _read_request(connection, reader)) is not None:
                await self._pass_on(connection, writer, *found)
                if connection.our_state is not h11.DONE or connection.their_state is not h11.DONE:
                    break
                connection.start_next_cycle()
        except (Cut, OSError, h11.ProtocolError, httpx.HTTPError):
            writer.transport.abort()
        finally:
            self._connections.discard(writer)
            with contextlib.suppress(OSError):
                writer.close()

    def _may_cut(self, target: str) -> None:
        if self.is_down or (target.startswith("/api/") and self.chance.random() < self.cut_part / 2):
            self.cuts += 1
            raise Cut

    async def _pass_on(
        self, connection: h11.Connection, writer: asyncio.StreamWriter, request: h11.Request, body: bytes
    ) -> None:
        late = self.chance.uniform(0, self.latency)
        on_the_way = self.chance.uniform(0, late)
        await asyncio.sleep(on_the_way)
        method, target = request.method.decode(), request.target.decode()
        self._may_cut(target)
        began = time.monotonic()
        headers = [(key, value) for key, value in request.headers if key not in HOP_BY_HOP]
        async with self._client.stream(method, target, headers=headers, content=body) as answer:
            kept = [(key, value) for key, value in answer.headers.raw if key.lower() not in HOP_BY_HOP]
            opening = h11.Response(status_code=answer.status_code, headers=kept)
            if answer.headers.get("content-type", "").startswith("text/event-stream"):
                await asyncio.sleep(late - on_the_way)
                writer.write(connection.send(opening) or b"")
                async for part in answer.aiter_raw():
                    writer.write(connection.send(h11.Data(part)) or b"")
                    await writer.drain()
            else:
                content = b"".join([part async for part in answer.aiter_raw()])
                now = time.monotonic()
                self.answered.append(Answered(method, target.split("?")[0], answer.status_code, now - began, now))
                await asyncio.sleep(late - on_the_way)
                self._may_cut(target)
                writer.write(connection.send(opening) or b"")
                writer.write(connection.send(h11.Data(content)) or b"")
            writer.write(connection.send(h11.EndOfMessage()) or b"")
            await writer.drain()


async def _read_request(connection: h11.Connection, reader: asyncio.StreamReader) -> tuple[h11.Request, bytes] | None:
    """The next request with its body; None when the browser has hung up."""
    request: h11.Request | None = None
    body = b""
    while True:
        event = connection.next_event()
        if event is h11.NEED_DATA:
            connection.receive_data(await reader.read(CHUNK))
        elif isinstance(event, h11.Request):
            request = event
        elif isinstance(event, h11.Data):
            body += bytes(event.data)
        elif isinstance(event, h11.EndOfMessage):
            assert request is not None
            return request, body
        else:
            return None
