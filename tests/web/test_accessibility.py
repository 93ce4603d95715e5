"""axe-core over every page, in both colour schemes: nobody is kept out. A new page is one more line of PAGES."""

from __future__ import annotations

from pathlib import Path

import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(180)]

AXE = Path(__file__).resolve().parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"

# Name, address, and what is there when the page is.
PAGES = [
    ("recordings", "/recordings", "main :is(h1, h2)"),
    ("recording", "/recordings/{recording}", "main :is(h1, h2)"),
    ("annotator", "/recordings/{recording}/annotate", "[data-picture][aria-busy=false]"),
    ("new import", "/imports/new", "main :is(h1, h2)"),
    ("tracks", "/tracks", "main :is(h1, h2)"),
    ("jobs", "/jobs", "main :is(h1, h2)"),
    ("missing", "/nowhere", "main :is(h1, h2)"),
]
# The same in the annotator with something open: the key that opens it, and what it is.
OPENED = [
    ("keyboard map", "F1", "[role=dialog]"),
    ("keys", "F2", "[role=dialog]"),
    ("search", "Control+k", "[role=dialog]"),
]


def find_faults(page) -> list[str]:
    """Serious and critical faults, each with the first element that has it."""
    # Added as the page's own script would not be let in by its policy.
    page.evaluate(AXE.read_text() + "; void 0")
    found = page.evaluate("async () => (await axe.run(document, { resultTypes: ['violations'] })).violations")
    return [
        f"{fault['id']} ({fault['impact']}): {fault['help']}: {fault['nodes'][0]['html'][:300]}"
        for fault in found
        if fault["impact"] in ("serious", "critical")
    ]


@pytest.mark.parametrize("scheme", ["dark", "light"])
@pytest.mark.parametrize(("name", "address", "sign"), PAGES, ids=[name for name, _, _ in PAGES])
def test_a_page_has_no_serious_fault(recording, open_page, name, address, sign, scheme):
    page = open_page(scheme=scheme)
    page.goto(address.format(recording=recording["id"]))
    page.locator(sign).first.wait_for()
    assert find_faults(page) == []


@pytest.mark.parametrize("scheme", ["dark", "light"])
@pytest.mark.parametrize(("name", "key", "sign"), OPENED, ids=[name for name, _, _ in OPENED])
def test_what_opens_over_a_page_has_no_serious_fault(recording, open_page, name, key, sign, scheme):
    page = open_page(scheme=scheme)
    page.goto(f"/recordings/{recording['id']}/annotate")
    page.locator("[data-picture][aria-busy=false]").first.wait_for()
    page.keyboard.press(key)
    page.locator(sign).first.wait_for()
    page.wait_for_timeout(300)
    assert find_faults(page) == []
