"""axe-core over every page, in both colour schemes: nobody is kept out. A new page is one more line of PAGES."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.web.conftest import import_copy

pytestmark = [pytest.mark.browser, pytest.mark.slow, pytest.mark.timeout(180)]

AXE = Path(__file__).resolve().parents[2] / "web" / "node_modules" / "axe-core" / "axe.min.js"

# Name, address, and what is there when the page is.
PAGES = [
    ("recordings", "/recordings", "main :is(h1, h2)"),
    ("recording", "/recordings/{recording}", "main :is(h1, h2)"),
    ("annotator", "/recordings/{recording}/annotate", "[data-picture][aria-busy=false]"),
    ("labels", "/recordings/{recording}/labels", "main :is(h1, h2)"),
    ("label check", "/recordings/{recording}/check", "main :is(h1, h2)"),
    ("calibrations", "/calibrations", "main :is(h1, h2)"),
    ("new calibration", "/calibrations/new", "main :is(h1, h2)"),
    ("projects", "/projects", "main :is(h1, h2)"),
    ("scans", "/scans", "main :is(h1, h2)"),
    ("moving", "/scans/moving", "main :is(h1, h2)"),
    ("curate", "/curate", "main :is(h1, h2)"),
    ("agreement of curators", "/curate/agreement", "main :is(h1, h2)"),
    ("hand models", "/models", "main :is(h1, h2)"),
    ("body", "/models/body", "[data-drawn=true]"),
    ("evaluations", "/evaluations", "main :is(h1, h2)"),
    ("account", "/account", "main :is(h1, h2)"),
    ("people", "/people", "main :is(h1, h2)"),
    ("audit", "/audit", "main :is(h1, h2)"),
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


# The choice of colours comes from another tab of the browser.
SHOW_LIGHT = """() => window.dispatchEvent(new StorageEvent("storage", {
  storageArea: localStorage, key: "handloom/colours", newValue: "light" }))"""
COLOURS = ["color-contrast", "link-in-text-block"]
"""Rules of axe-core that another colour scheme can break."""


def find_faults_dark_and_light(page) -> list[str]:
    """All faults in dark colours, then what light ones add; the page is light from then on."""
    faults = find_faults(page)
    page.evaluate(SHOW_LIGHT)
    page.wait_for_function("() => document.documentElement.dataset.mantineColorScheme === 'light'")
    return faults + find_faults(page, COLOURS)


def find_faults(page, rules: list[str] | None = None) -> list[str]:
    """Serious and critical faults by some rules, or all, each with the first element that has it."""
    # Added as the page's own script would not be let in by its policy.
    page.evaluate(AXE.read_text() + "; void 0")
    options = {"resultTypes": ["violations"]} | ({"runOnly": rules} if rules else {})
    found = page.evaluate("async (options) => (await axe.run(document, options)).violations", options)
    return [
        f"{fault['id']} ({fault['impact']}): {fault['help']}: {fault['nodes'][0]['html'][:300]}"
        for fault in found
        if fault["impact"] in ("serious", "critical")
    ]


@pytest.fixture(scope="module")
def looked_at(studio, synthesized) -> str:
    """Id of the recording that is looked at; nobody changes it."""
    return import_copy(studio, synthesized)["id"]


@pytest.fixture(scope="module")
def page(browser, studio):
    """One page that goes from address to address; nothing moves, so that colours are seen as they stay."""
    size = {"width": 1280, "height": 720}
    context = browser.new_context(viewport=size, base_url=studio.url, locale="en-GB", reduced_motion="reduce")
    context.set_default_timeout(30_000)
    context.add_init_script("localStorage.setItem('handloom/colours', 'dark')")
    yield context.new_page()
    context.close()


@pytest.mark.parametrize(("name", "address", "sign"), PAGES, ids=[name for name, _, _ in PAGES])
def test_a_page_has_no_serious_fault(looked_at, page, name, address, sign):
    page.goto(address.format(recording=looked_at))
    page.locator(sign).first.wait_for()
    assert find_faults_dark_and_light(page) == []


@pytest.mark.parametrize(("name", "key", "sign"), OPENED, ids=[name for name, _, _ in OPENED])
def test_what_opens_over_a_page_has_no_serious_fault(looked_at, page, name, key, sign):
    page.goto(f"/recordings/{looked_at}/annotate")
    page.locator("[data-picture][aria-busy=false]").first.wait_for()
    page.keyboard.press(key)
    page.locator(sign).first.wait_for()
    page.wait_for_timeout(100)
    assert find_faults_dark_and_light(page) == []


def test_who_asked_for_less_motion_sees_other_colours_at_once(looked_at, page):
    page.goto(f"/recordings/{looked_at}/annotate")
    page.locator("[data-testid=suggested-by] kbd").first.wait_for()
    page.keyboard.press("F1")
    page.locator("[role=dialog]").first.wait_for()
    moving = f"""() => {{ ({SHOW_LIGHT})(); return new Promise((seen) => new MutationObserver(() => requestAnimationFrame(() =>
      seen(document.getAnimations().filter((each) => each instanceof CSSTransition).map((each) => each.effect.target.outerHTML.slice(0, 200) + each.transitionProperty)))).observe(document.documentElement, {{ attributeFilter: ["data-mantine-color-scheme"] }})) }}"""
    assert page.evaluate(moving) == []
