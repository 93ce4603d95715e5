"""Going through a long recording in a real browser: every frame is seen, none is left out."""

from __future__ import annotations

import json
import logging
import os
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest

pytestmark = [pytest.mark.browser, pytest.mark.timeout(240)]

FRAMES = 1500
LAST = min(FRAMES - 1, int(os.environ.get("HANDLOOM_SCRUB_TO", "600")))
"""Where scrubbing ends: the whole recording takes 50 s, so one asks for it (docs/annotating.md)."""

FPS = 30
SIZE = (320, 240)

BITS = 11
STRIPE = 16
"""px: how wide a bit of the number is."""

# Notes which frame is on the screen, whenever the picture has been drawn.
WATCH = """() => {
  const pane = document.querySelector('[data-picture]');
  window.drawn = [];
  new MutationObserver((records) => {
    for (const record of records) window.drawn.push([Number(pane.dataset.drawn), performance.now()]);
  }).observe(pane, { attributes: true, attributeFilter: ['data-drawn'] });
}"""

# One press of F every 1/30 s, whether the picture has come or not; as in a film, a late press does not wait.
SCRUB = """([frames, fps]) => new Promise((resolve) => {
  const begin = performance.now();
  let pressed = 0;
  const timer = setInterval(() => {
    const due = Math.min(frames, Math.floor((performance.now() - begin) * fps / 1000));
    if (pressed < due) {
      const press = new KeyboardEvent('keydown', { key: 'f', code: 'KeyF', bubbles: true, cancelable: true });
      document.activeElement.dispatchEvent(press);
      pressed += 1;
    }
    if (pressed === frames) { clearInterval(timer); resolve(performance.now() - begin); }
  }, 1);
})"""


@pytest.fixture(scope="module")
def browser(playwright: Any, chromium: str) -> Iterator[Any]:
    """Without SwiftShader, which other tests need for WebGL: drawing through it takes 40 ms a frame by itself."""
    launched = playwright.chromium.launch(executable_path=chromium, args=["--no-sandbox", "--disable-gpu"])
    yield launched
    launched.close()


@pytest.fixture(scope="module")
def long_recording(studio: Any, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """1,500 JPEGs, each with its number as a bar code of 11 stripes."""
    archive = tmp_path_factory.mktemp("long") / "long.zip"
    _write_recording(archive)
    with archive.open("rb") as file:
        made = studio.send("POST", "/imports", files={"files": ("long.zip", file)})
    made.raise_for_status()
    assert made.json()["state"] == "checked", made.json()["report"]["problems"]
    stored = studio.send("POST", f"/imports/{made.json()['id']}/confirm", json={"name": "Long"})
    stored.raise_for_status()
    return stored.json()


def _write_recording(archive: Path) -> None:
    width, height = SIZE
    rows, columns = np.mgrid[:height, :width]
    ground = np.stack([columns % 256, rows % 256, (columns + rows) % 256], axis=-1).astype(np.uint8)
    camera = {
        "id": "cam0",
        "width": width,
        "height": height,
        "K": [[500, 0, width / 2], [0, 500, height / 2], [0, 0, 1]],
        "distortion": [],
        "T_world_camera": np.eye(4).tolist(),
        "color": "color/{:06d}.jpg",
        "depth": None,
    }
    description = {
        "version": 1,
        "name": "long",
        "fps": FPS,
        "frame_count": FRAMES,
        "cameras": [camera],
        "hands": ["right"],
        "objects": [],
    }
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_STORED) as file:
        file.writestr("long/sequence.json", json.dumps(description))
        for frame in range(FRAMES):
            image = np.roll(ground, 3 * frame, axis=1)
            for bit in range(BITS):
                image[:STRIPE, bit * STRIPE : (bit + 1) * STRIPE] = 255 * (frame >> bit & 1)
            file.writestr(
                f"long/color/{frame:06d}.jpg", cv2.imencode(".jpg", image, [cv2.IMWRITE_JPEG_QUALITY, 80])[1].tobytes()
            )


def read_number(page: Any) -> int:
    """The number of the frame on the screen, by its stripes."""
    bits = page.evaluate(
        """([bits, stripe]) => {
          const pane = document.querySelector('[data-picture]');
          const view = JSON.parse(pane.dataset.view);
          const canvas = pane.querySelector('canvas');
          const ratio = canvas.width / canvas.clientWidth;
          const context = canvas.getContext('2d');
          return Array.from({ length: bits }, (_, bit) => {
            const x = Math.round(ratio * (view.x + view.scale * stripe * (bit + 0.5)));
            const y = Math.round(ratio * (view.y + view.scale * stripe * 0.5));
            return context.getImageData(x, y, 1, 1).data[0] > 127 ? 1 : 0;
          });
        }""",
        [BITS, STRIPE],
    )
    return sum(value << bit for bit, value in enumerate(bits))


@pytest.mark.slow
def test_scrubbing_forward_at_thirty_frames_a_second_shows_every_frame(
    studio, long_recording, open_page, picture_of, record_property
):
    page = open_page()
    page.goto(f"/recordings/{long_recording['id']}/annotate")
    picture = picture_of(page)
    picture.wait()
    page.wait_for_function("() => document.querySelector('[data-picture]').dataset.drawn === '0'")
    assert read_number(page) == 0

    page.evaluate(WATCH)
    took_ms = page.evaluate(SCRUB, [LAST, FPS])
    page.wait_for_function("(last) => document.querySelector('[data-picture]').dataset.drawn === last", arg=str(LAST))
    assert read_number(page) == LAST, "what is said to be drawn is what is on the screen"

    drawn = page.evaluate("window.drawn")
    frames = [int(frame) for frame, _ in drawn]
    gaps = np.diff([time for _, time in drawn])
    dropped = sorted(set(range(1, LAST + 1)) - set(frames))
    report = (
        f"{len(set(frames))} of {LAST} frames drawn in {took_ms / 1000:.1f} s, "
        f"{len(dropped)} left out {dropped[:10]}; "
        f"interval median {np.median(gaps):.1f} ms, p99 {np.percentile(gaps, 99):.1f} ms, longest {gaps.max():.1f} ms"
    )
    record_property("scrubbing", report)
    logging.getLogger(__name__).info(report)
    assert frames == sorted(frames), "no frame is shown after a later one"
    assert not dropped, report
    assert took_ms < 1.05 * 1000 * LAST / FPS, report
