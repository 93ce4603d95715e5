"""A recording with depth from a rectified infrared pair: `python -m benchmarks.real_marks.stereo_depth DATA OUT`.

DATA is `d405_take001`: three RealSense D405 in a cluttered room. The images of one camera's pair are matched (OpenCV's
semi-global matching, checked from both sides); the left image stands for colour.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.sequence import Sequence, load_sequence

DISPARITIES, BLOCK = 96, 3
"""From 96 px, 7 cm before such a camera, to the wall; the smallest blocks, because an outline grows by half of one:
with 7 px the hand was so long that 67 and 45 % of the fingertips of two cameras were right in place of 74 and 65 %."""

DEPTH_SCALE = 0.0001
"""m per unit of the depth images."""

FARTHEST = 1.0
"""m; behind it half a pixel of disparity is 7 cm."""


def measure_disparity(left: npt.NDArray[np.uint8], right: npt.NDArray[np.uint8]) -> npt.NDArray[np.float32]:
    """(H, W) px, 0 where the two directions of matching differ by more than a pixel or no match stands out."""
    matcher = cv2.StereoSGBM.create(
        minDisparity=0,
        numDisparities=DISPARITIES,
        blockSize=BLOCK,
        P1=8 * BLOCK**2,
        P2=32 * BLOCK**2,
        disp12MaxDiff=1,
        uniquenessRatio=5,
        speckleWindowSize=100,
        speckleRange=1,
        mode=cv2.STEREO_SGBM_MODE_HH,
    )
    padded = [cv2.copyMakeBorder(image, 0, 0, DISPARITIES, 0, cv2.BORDER_REPLICATE) for image in (left, right)]
    found = matcher.compute(padded[0], padded[1])[:, DISPARITIES:].astype(np.float32) / 16.0
    return np.maximum(found, 0.0)


def write_images(data: Path, camera: int, color: Path, depths: Path) -> int:
    """Write the left image and the depth (units of `DEPTH_SCALE`) of every frame of one camera's pair; their number."""
    about = json.loads((data / "meta.json").read_text())["cameras"][camera]
    lens, baseline = about["ir_left"], about["stereo_baseline_m"]
    pair = [cv2.VideoCapture(str(data / f"cam{camera}_ir{side}.avi")) for side in "LR"]
    for folder in (color, depths):
        folder.mkdir(parents=True, exist_ok=True)
    count = 0
    while True:
        (is_left, left), (is_right, right) = (video.read() for video in pair)
        if not (is_left and is_right):
            break
        disparity = measure_disparity(*(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) for image in (left, right)))
        with np.errstate(divide="ignore"):
            depth = np.where(disparity > 0, lens["fx"] * baseline / disparity, 0.0)
        depth[depth > FARTHEST] = 0.0
        cv2.imwrite(str(color / f"{count:06d}.png"), left)
        cv2.imwrite(str(depths / f"{count:06d}.png"), np.rint(depth / DEPTH_SCALE).astype(np.uint16))
        count += 1
    return count


def make_recording(data: Path, camera: int, out: Path) -> Sequence:
    """Import the depth and the left image of one camera's pair into the folder `out`."""
    source = out.parent / f"{out.name}_images"
    write_images(data, camera, source / "color", source / "depth")
    lens = json.loads((data / "meta.json").read_text())["cameras"][camera]["ir_left"]
    options = ImportOptions(
        fps=4.5,
        fx=lens["fx"],
        fy=lens["fy"],
        cx=lens["ppx"],
        cy=lens["ppy"],
        depth_scale=DEPTH_SCALE,
        hands=("right",),
    )
    run_import(source, out, "rgbd_folder", options)
    return load_sequence(out)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("data", type=Path)
    parser.add_argument("out", type=Path)
    parser.add_argument("--camera", type=int, default=0)
    given = parser.parse_args()
    print(make_recording(given.data, given.camera, given.out).frame_count, "frames")


if __name__ == "__main__":
    main()
