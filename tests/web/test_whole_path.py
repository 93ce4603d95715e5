"""The whole path in a real browser: a recording goes in, a tracked hand comes out."""

from __future__ import annotations

import base64
import re
import time

import cv2
import numpy as np
import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(600)]

DROP = """async ([name, content]) => {
  const bytes = Uint8Array.from(atob(content), (c) => c.charCodeAt(0));
  const transfer = new DataTransfer();
  transfer.items.add(new File([bytes], name, { type: "application/zip" }));
  for (const type of ["dragenter", "dragover", "drop"])
    window.dispatchEvent(new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true }));
}"""


@pytest.mark.slow
def test_a_recording_is_dropped_annotated_tracked_and_seen_in_3d(
    studio, synthesized, open_page, picture_of, screenshots
):
    from playwright.sync_api import expect

    page = open_page()

    # Import: dropped on the page, reported, stored.
    page.goto("/")
    expect(page.get_by_role("heading", name="Recordings", exact=True)).to_be_visible()
    screenshots.take(page, "01-first-use")
    page.evaluate(DROP, [synthesized.archive.name, base64.b64encode(synthesized.archive.read_bytes()).decode()])
    expect(page.get_by_role("heading", name="Import report")).to_be_visible()
    expect(page.get_by_text("16", exact=True).first).to_be_visible()
    screenshots.take(page, "02-import-report")
    page.get_by_label("Name of the recording").fill("Hand that opens")
    page.get_by_role("button", name="Store the recording").click()
    expect(page.get_by_role("heading", name="Hand that opens")).to_be_visible()
    recording_id = page.url.rsplit("/", 1)[1]
    screenshots.take(page, "03-recording")

    # Annotate: 21 clicks, and each is where it was made.
    page.get_by_role("main").get_by_role("link", name="Annotate").click()
    picture = picture_of(page)
    picture.wait()
    for x, y in synthesized.joints:
        picture.click(x, y)
    expect(page.get_by_role("tab", name="right 21/21")).to_be_visible()
    picture.wait_until_saved()
    screenshots.take(page, "04-annotated")

    # Reload: nothing is lost.
    page.reload()
    picture.wait()
    expect(page.get_by_role("tab", name="right 21/21")).to_be_visible()
    [stored] = studio.get(f"/sequences/{recording_id}/annotations")["items"]
    assert (stored["frame"], stored["hand"]) == (0, "right")
    distances = np.linalg.norm(np.array(stored["points"])[:, :2] - np.array(synthesized.joints), axis=1)
    assert distances.max() < 0.6, "a click lands within half a screen pixel of where it was aimed"
    assert all(v == 2 for _, _, v in stored["points"])

    # Track: started here, watched to its end.
    page.goto(f"/recordings/{recording_id}")
    page.get_by_role("button", name="Track …").first.click()
    expect(page.get_by_label("Iterations", exact=True)).to_be_visible()
    screenshots.take(page, "05-start-tracking")
    page.get_by_role("button", name="Start tracking").click()
    page.wait_for_url(re.compile(r"/jobs/[0-9a-f-]{36}$"))
    screenshots.take(page, "06-job-running")
    expect(page.get_by_role("link", name="Open the track")).to_be_visible(timeout=300_000)
    screenshots.take(page, "07-job-done")

    # Look: the viewer draws, the image has its overlay, the frames are linked.
    page.get_by_role("link", name="Open the track").click()
    canvas = page.frame_locator("iframe").locator("canvas").first
    canvas.wait_for(timeout=60_000)
    page.get_by_label("Cloud").uncheck()
    share = _wait_for_orange(canvas)
    assert share > 0.01, f"without the cloud the fitted right hand is seen in 3D; {share:.2%} of the view is orange"
    page.get_by_label("Cloud").check()
    expect(page.get_by_test_id("frame")).to_have_text("frame 0")
    page.get_by_role("button", name="Next frame").click()
    expect(page.get_by_test_id("frame")).to_have_text("frame 1")
    expect(page).to_have_url(re.compile(r"frame=1"))
    picture_of(page).wait()
    page.wait_for_timeout(1500)
    screenshots.take(page, "08-track")

    [track] = studio.get(f"/tracks?sequence_id={recording_id}")["items"]
    assert track["summary"]["lost"] == 0
    assert track["frame_count"] == 16

    # And on to the annotator at that frame, by one key.
    page.get_by_label("Image of frame 1").click()
    page.keyboard.press("a")
    page.wait_for_url(re.compile(r"/annotate\?.*frame=1"))


def _wait_for_orange(canvas, seconds: float = 60) -> float:
    """Share of the viewer's pixels in the colour of the right hand, once it is worth mentioning."""
    deadline = time.monotonic() + seconds
    share = 0.0
    while share <= 0.01 and time.monotonic() < deadline:
        time.sleep(0.5)
        image = cv2.imdecode(np.frombuffer(canvas.screenshot(), np.uint8), cv2.IMREAD_COLOR)
        assert image is not None
        hue, saturation, value = cv2.split(cv2.cvtColor(image, cv2.COLOR_BGR2HSV))
        share = float(((hue > 5) & (hue < 25) & (saturation > 110) & (value > 60)).mean())
    return share
