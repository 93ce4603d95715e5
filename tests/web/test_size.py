"""What goes over the wire until somebody sees a page, with an empty cache; and the page of the API."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

pytestmark = pytest.mark.browser

FIRST_PAGE = 350_000
ANNOTATOR = 600_000
"""Bytes as they were sent: scripts, styles, fonts and the first data."""


class Wire:
    """Counts what a page is sent, by Chromium's own account; each address once, because lists are asked for again
    whenever a job of another test goes on."""

    def __init__(self, page: Any) -> None:
        self.addresses: dict[str, str] = {}
        self.sizes: dict[str, float] = {}
        session = page.context.new_cdp_session(page)
        session.send("Network.enable")
        session.send("Network.setCacheDisabled", {"cacheDisabled": True})
        session.on("Network.responseReceived", self._note)
        session.on("Network.loadingFinished", self._add)

    def _note(self, event: Any) -> None:
        self.addresses[event["requestId"]] = event["response"]["url"]

    def _add(self, event: Any) -> None:
        self.sizes[event["requestId"]] = event["encodedDataLength"]

    def by_address(self) -> dict[str, float]:
        """The largest answer of each."""
        found: dict[str, float] = {}
        for id_, size in self.sizes.items():
            address = self.addresses.get(id_, "?")
            found[address] = max(size, found.get(address, 0.0))
        return found

    def report(self) -> str:
        rows = sorted(((size, address) for address, size in self.by_address().items()), reverse=True)
        return "\n".join([f"{self.total:.0f} in all", *(f"{size:9.0f} {url}" for size, url in rows[:20])])

    @property
    def total(self) -> float:
        return sum(self.by_address().values())


@contextmanager
def only(studio: Any, sequence_id: str) -> Iterator[None]:
    """The recordings that other tests have left lie in the bin meanwhile: each adds its line and its picture."""
    others = [one["id"] for one in studio.get("/sequences?limit=100")["items"] if one["id"] != sequence_id]
    for other in others:
        studio.send("DELETE", f"/sequences/{other}").raise_for_status()
    yield
    for other in others:
        studio.send("POST", f"/sequences/{other}/restore").raise_for_status()


def test_the_first_page_and_the_annotator_are_sent_in_few_bytes(studio, recording, open_page, picture_of):
    with only(studio, recording["id"]):
        page = open_page()
        wire = Wire(page)
        page.goto("/recordings")
        page.get_by_text(recording["name"]).first.wait_for()
        page.wait_for_function("() => document.fonts.status === 'loaded'")
    assert wire.total > 100_000, "something was counted"
    logging.getLogger(__name__).info("first page: %s", wire.report())
    assert wire.total <= FIRST_PAGE, wire.report()

    page = open_page()
    wire = Wire(page)
    page.goto(f"/recordings/{recording['id']}/annotate")
    picture_of(page).wait()
    page.wait_for_function("() => document.fonts.status === 'loaded'")
    logging.getLogger(__name__).info("annotator: %s", wire.report())
    assert wire.total <= ANNOTATOR, wire.report()
    assert wire.total > 100_000


def test_the_page_of_the_api_shows_every_request_and_loads_nothing_from_elsewhere(studio, open_page, screenshots):
    page = open_page()
    foreign: list[str] = []
    page.on("request", lambda request: None if request.url.startswith(studio.url) else foreign.append(request.url))
    page.goto("/recordings")
    page.get_by_role("button", name="Account of").click()
    page.get_by_role("menuitem", name="API for scripts").click()
    paths = studio.get("/openapi.json")["paths"]
    page.get_by_role("heading", name="API", exact=True).wait_for()
    page.locator(".mantine-Accordion-item").first.wait_for()
    assert page.locator(".mantine-Accordion-item").count() == sum(len(item) for item in paths.values())
    screenshots.take(page, "api")
    page.get_by_label("Find a request").fill("replace what is left out of a scan")
    found = page.locator(".mantine-Accordion-item")
    page.wait_for_function("() => document.querySelectorAll('.mantine-Accordion-item').length === 1")
    found.get_by_role("button").click()
    page.get_by_text("drops_objects").first.wait_for()
    screenshots.take(page, "api-one")
    assert not foreign
