"""A browser has six connections to a server: pages that are left or hidden give theirs back."""

from __future__ import annotations

import pytest

from tests.web.conftest import CHROMIUM_FLAGS

pytestmark = [pytest.mark.browser, pytest.mark.timeout(120)]

PLACES = ("/recordings", "/projects", "/tracks", "/scans", "/curate", "/models", "/evaluations", "/jobs", "/bin")


def test_a_ninth_page_opens_beside_eight_others_that_the_browser_keeps(playwright, chromium, studio):
    """Playwright has the browser forget pages that are left; people's browsers keep them, with their connections."""
    browser = playwright.chromium.launch(
        executable_path=chromium, args=list(CHROMIUM_FLAGS), ignore_default_args=["--disable-back-forward-cache"]
    )
    try:
        page = browser.new_context(base_url=studio.url).new_page()
        for place in PLACES:
            page.goto(place, timeout=20_000)
            page.get_by_role("heading", level=1).first.wait_for(state="attached")
    finally:
        browser.close()
