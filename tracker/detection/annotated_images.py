"""Images of a recording with the fingertips that somebody marked in them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import ABSENT, JOINT_NAMES, VISIBLE, Annotation, Annotations
from tracker.capture.exposure import brighten_frame
from tracker.capture.frame import Frame
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.sequence import Sequence
from tracker.detection.patch_image import PatchImage
from tracker.observation import Preprocessing, Region, observe

Array = npt.NDArray[np.float64]

TIPS = tuple(index for index, name in enumerate(JOINT_NAMES) if name.endswith("_tip"))

SIDE_MARGIN = 0.060
"""Room around the marked joints in the image, m."""

DEPTH_MARGIN = 0.150
"""Room before the nearest and behind the farthest joint that is seen, m."""


@dataclass(frozen=True)
class AnnotatedImage:
    """The part of an image with the marked hands.

    Attributes:
        name: For people: recording and frame.
        region: Where that part lies in the image.
        image: What a forest looks at in it.
        tips: (T, 2) column and row of the marked fingertips in that part, px.
        is_visible: (T,) seen, not occluded.
    """

    name: str
    region: Region
    image: PatchImage
    tips: Array
    is_visible: npt.NDArray[np.bool_]


def annotated_images(
    sequence: Sequence, annotations: Annotations, step: int = 1, use_skin: bool = True
) -> Iterator[AnnotatedImage]:
    """Images with depth in which hands are marked, every `step`-th of each camera in the order of frames.

    Images in which no marked joint has depth are left out: where the hand is cannot be said.

    Args:
        sequence: A recording.
        annotations: Of its frames.
        step: One of so many annotated images.
        use_skin: Look at hand pixels by colour only, where there is colour.
    """
    assert step >= 1
    for camera in sequence.cameras:
        if not camera.has_depth:
            continue
        frames = sorted({item.frame for item in annotations.items if item.camera == camera.id})
        for index in [frame for frame in frames if frame < sequence.frame_count][::step]:
            hands = [item for item in annotations.at(index) if item.camera == camera.id]
            frame = brighten_frame(sequence.frame(index, camera.id))
            found = _cut_out(f"{sequence.name}, frame {index}", frame, camera, hands, use_skin)
            if found is not None:
                yield found


def count_images(sequence: Sequence, annotations: Annotations, step: int = 1) -> int:
    """How many images `annotated_images` takes at most."""
    count = 0
    for camera in sequence.cameras:
        frames = {item.frame for item in annotations.items if item.camera == camera.id}
        if camera.has_depth:
            count += -(-len([frame for frame in frames if frame < sequence.frame_count]) // step)
    return count


def _cut_out(
    name: str, frame: Frame, camera: RecordedCamera, hands: list[Annotation], use_skin: bool
) -> AnnotatedImage | None:
    points = np.concatenate([item.points for item in hands])
    marked = points[points[:, 2] != ABSENT]
    region = _region(frame, camera, marked)
    if region is None:
        return None
    observation = observe(frame, camera, region, Preprocessing(use_skin=use_skin))
    tips = np.concatenate([item.points[list(TIPS)] for item in hands])
    tips = tips[tips[:, 2] != ABSENT]
    return AnnotatedImage(
        name,
        region,
        PatchImage.of(observation),
        tips[:, :2] - np.array([region.column, region.row]),
        tips[:, 2] == VISIBLE,
    )


def _region(frame: Frame, camera: RecordedCamera, marked: Array) -> Region | None:
    """Around marked joints (N, 3) column, row, v; their depths are read where they are seen."""
    assert frame.depth is not None
    columns, rows = np.rint(marked[:, 0]).astype(int), np.rint(marked[:, 1]).astype(int)
    inside = (columns >= 0) & (rows >= 0) & (columns < camera.width) & (rows < camera.height)
    seen = inside & (marked[:, 2] == VISIBLE)
    depths = frame.depth[rows[seen], columns[seen]]
    depths = depths[depths > 0.0]
    if len(depths) == 0:
        return None
    middle = float(np.median(depths))
    depths = depths[np.abs(depths - middle) < 0.3]  # a joint beside the hand's outline lies on the wall
    margin = int(np.ceil(SIDE_MARGIN * camera.K[0, 0] / middle))
    left, top = max(0, columns[inside].min() - margin), max(0, rows[inside].min() - margin)
    right = min(camera.width, columns[inside].max() + margin + 1)
    bottom = min(camera.height, rows[inside].max() + margin + 1)
    near, far = float(depths.min()) - DEPTH_MARGIN, float(depths.max()) + DEPTH_MARGIN
    return Region(int(top), int(left), int(bottom - top), int(right - left), max(0.05, near), far)
