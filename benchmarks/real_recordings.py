"""How well real recordings are tracked: `python -m benchmarks.real_recordings FOLDER [--ball] [--pictures DIR]`.

FOLDER holds `uvr_sphere_green` (a hand turning a ball, with colour) and `sr305_depth` (an open hand, depth alone).
There is no truth; what is measured is whether the fitted surface lies on the depth image, and pictures are made to look
at: a palm that fits well hides fingers that do not in the median, less so in the share of pixels within 10 mm.
"""

from __future__ import annotations

import argparse
import tempfile
from pathlib import Path

import cv2
import numpy as np

from benchmarks.real_ball import add_ball, describe_ball, measure_radius
from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.sequence import Sequence, load_sequence
from tracker.evaluation import measure_depth_distances
from tracker.fitting.options import TrackOptions
from tracker.fitting.region import depth_range, whole_image
from tracker.inspection.frame_view import render_overlay
from tracker.observation import HAND, OTHER, observe
from tracker.tracking.follow import track_frames
from tracker.tracking.start import start_tracking
from tracker.tracking.track import Track, join_chunks

SPHERE = ImportOptions(fps=30.0, fx=238.95, fy=238.95, cx=160.0, cy=120.0, depth_scale=0.001, hands=("right",))
OPEN_HAND = ImportOptions(
    fps=30.0, fx=476.007, fy=476.007, cx=313.683, cy=242.755, depth_scale=0.000125, hands=("right",), allow_gaps=True
)
RECORDINGS = {
    "uvr_sphere_green": SPHERE,
    "sr305_depth/20210326-230536": OPEN_HAND,
    "sr305_depth/20210326-231615": OPEN_HAND,
}


def track(sequence: Sequence, annotations: Annotations | None) -> Track:
    """The track of all frames with the default hand, calibrated."""
    options = TrackOptions()
    setup, state = start_tracking(sequence, options, None, annotations)
    _, chunk = track_frames(sequence, setup, state, options.frame_range(sequence.frame_count))
    return join_chunks(sequence, setup, [chunk])


def measure(name: str, sequence: Sequence, found: Track) -> str:
    """A row of the table."""
    medians, near = [], []
    for place in np.flatnonzero(found.status != "lost"):
        distances = measure_depth_distances(sequence, found.setup, found.pose[place], int(found.frame[place]))
        if distances.size:
            medians.append(1e3 * np.median(distances))
            near.append(100.0 * np.mean(distances < 0.010))
    counts = [int(np.sum(found.status == status)) for status in ("ok", "recovered", "lost")]
    errors = (
        f"{np.median(medians):.2f} | {np.max(medians):.2f} | {np.median(near):.1f} | {np.min(near):.1f}"
        if medians
        else "- | - | - | -"
    )
    median_ms = 1e3 * float(np.median(found.seconds))
    return f"| {name} | {len(found.frame)} | {' | '.join(map(str, counts))} | {errors} | {median_ms:.1f} |"


def draw(sequence: Sequence, found: Track, place: int) -> np.ndarray:
    """The image of a frame, BGR, beside the same with the fitted hand over it."""
    index, camera_id = int(found.frame[place]), found.setup.camera_id
    frame = sequence.frame(index, camera_id)
    if frame.color is not None:
        image = frame.color[:, :, ::-1].copy()
    else:
        depth = frame.depth
        assert depth is not None
        near = np.percentile(depth[depth > 0], 1)
        shade = np.where(depth > 0, 255 * np.clip(1.0 - (depth - near) / 0.4, 0.0, 1.0), 0).astype(np.uint8)
        image = cv2.applyColorMap(shade, cv2.COLORMAP_BONE)
    overlay = render_overlay(sequence, found.setup, found.pose[place], index, camera_id)
    alpha = overlay[:, :, 3:] / 255.0
    mixed = (image * (1.0 - alpha) + overlay[:, :, 2::-1] * alpha).astype(np.uint8)
    text = f"frame {index}: {found.status[place]}"
    cv2.putText(mixed, text, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (255, 255, 255), 1, cv2.LINE_AA)
    return np.hstack([image, mixed])


def outline(sequence: Sequence, found: Track, place: int) -> np.ndarray:
    """The fitted hand under the outline of what was seen, BGR: shows the fit and nothing of the recording's images."""
    index, camera_id = int(found.frame[place]), found.setup.camera_id
    frame = sequence.frame(index, camera_id)
    assert frame.depth is not None
    camera = sequence.camera(camera_id)
    region = whole_image(camera, *depth_range(frame))
    seen = observe(frame, camera, region, found.setup.preprocessing)
    scale = max(1, 640 // camera.width)
    overlay = render_overlay(sequence, found.setup, found.pose[place], index, camera_id)
    image = cv2.resize((overlay[:, :, 2::-1] * (overlay[:, :, 3:] > 0)).astype(np.uint8), None, fx=scale, fy=scale)
    for label, colour in ((OTHER, (105, 200, 90)), (HAND, (255, 255, 255))):
        mask = cv2.resize(((seen.labels & label) > 0).astype(np.uint8), None, fx=scale, fy=scale)
        contours, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_NONE)
        cv2.drawContours(image, [c for c in contours if len(c) > 12 * scale], -1, colour, 1, cv2.LINE_AA)
    middle = int(np.median(np.nonzero(image.any(axis=2))[1]))
    left = int(np.clip(middle - 200, 0, image.shape[1] - 400))
    tile = image[:440, left : left + 400].copy()
    text = f"frame {index}: {found.status[place]}"
    cv2.putText(tile, text, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (255, 255, 255), 1, cv2.LINE_AA)
    return tile


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="+", default=list(RECORDINGS), choices=list(RECORDINGS))
    parser.add_argument("--annotations", type=Path, help="of uvr_sphere_green; it starts by itself otherwise")
    parser.add_argument("--pictures", type=Path, help="write four frames of each recording here")
    parser.add_argument("--outlines", type=Path, help="write one picture a recording here, outlines in place of images")
    parser.add_argument("--ball", action="store_true", help="track uvr_sphere_green again with its ball as an object")
    args = parser.parse_args()
    print("| recording | frames | ok | recovered | lost | median mm | worst | % within 10 mm | worst | median ms |")
    print("|---|---|---|---|---|---|---|---|---|---|")
    for name in args.only:
        with tempfile.TemporaryDirectory() as temporary:
            folder = Path(temporary) / "recording"
            run_import(args.folder / name, folder, "rgbd_folder", RECORDINGS[name])
            sequence = load_sequence(folder)
            marked = args.annotations if name == "uvr_sphere_green" else None
            annotations = load_annotations(marked) if marked else None
            found = track(sequence, annotations)
            print(measure(name, sequence, found), flush=True)
            show(args, name, sequence, found)
            if args.ball and name == "uvr_sphere_green":
                radius = measure_radius(sequence, found)
                sequence = add_ball(sequence, radius)
                found = track(sequence, annotations)
                print(measure(f"{name}, with its ball", sequence, found), flush=True)
                print(f"radius {1e3 * radius:.1f} mm; {describe_ball(sequence, found)}", flush=True)
                show(args, f"{name}_with_ball", sequence, found)


def show(args: argparse.Namespace, name: str, sequence: Sequence, found: Track) -> None:
    """Write the pictures that were asked for."""
    if args.outlines:
        args.outlines.mkdir(parents=True, exist_ok=True)
        places = np.linspace(0, len(found.frame) - 1, 6).astype(int)[1:5]
        tiles = [outline(sequence, found, int(place)) for place in places]
        cv2.imwrite(str(args.outlines / f"{name.replace('/', '_')}.png"), np.hstack(tiles))
    if args.pictures:
        args.pictures.mkdir(parents=True, exist_ok=True)
        for place in np.linspace(0, len(found.frame) - 1, 4).astype(int):
            file = f"{name.replace('/', '_')}_{int(found.frame[place]):03d}.png"
            cv2.imwrite(str(args.pictures / file), draw(sequence, found, int(place)))


if __name__ == "__main__":
    main()
