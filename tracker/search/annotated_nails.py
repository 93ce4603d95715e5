"""Annotated colour images as images to learn finger nails from.

People mark joints, not nails: a hand is fitted to the joints of each moment, in all its views together, and its nails
are where that hand has them.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import JOINT_NAMES, VISIBLE, Annotation, Annotations
from tracker.capture.exposure import brighten
from tracker.capture.frame import Frame
from tracker.capture.sequence import Sequence
from tracker.detection.annotated_images import AnnotatedImage
from tracker.fitting.view_hands import ViewHands
from tracker.landmarks import DetectedHand
from tracker.model.default_hand import default_hand
from tracker.model.scene import PosedScene, Scene
from tracker.observation import undistort
from tracker.rendering.seen_nails import NailPlaces
from tracker.search.nail_views import draw_nail_view
from tracker.search.place_in_views import place_in_views
from tracker.search.start_annotated import start_hand, undistort_points

Array = npt.NDArray[np.float64]

ENOUGH = 12
"""Joints that an annotation must have for the hand's pose to be known from it."""

STEPS = 30
"""Gauss-Newton steps to the joints of one view."""

NEAR = 0.015
"""m; where the fitted fingertip is farther from the marked one than this, the image says nothing of its nail."""

TIPS = np.array([index for index, name in enumerate(JOINT_NAMES) if name.endswith("_tip")])


def annotated_nail_images(sequence: Sequence, annotations: Annotations, step: int = 1) -> Iterator[AnnotatedImage]:
    """Colour images in which hands are marked, of every `step`-th annotated frame.

    A nail whose fingertip was not marked as visible, or lies elsewhere than the fitted hand has it, is there but
    hidden: nothing is learnt around it. One that the fitted hand turns away is left out: what is there is no nail.

    Args:
        sequence: A recording with colour.
        annotations: Of its frames.
        step: One of so many annotated frames.
    """
    colored = {camera.id for camera in sequence.cameras if camera.has_color}
    for frame in list_frames(sequence, annotations)[::step]:
        by_hand: dict[str, list[Annotation]] = defaultdict(list)
        for item in annotations.at(frame):
            if item.camera in colored and np.count_nonzero(item.points[:, 2]) >= ENOUGH:
                by_hand[item.hand].append(item)
        yield from _cut_out_all(sequence, frame, by_hand)


def list_frames(sequence: Sequence, annotations: Annotations) -> list[int]:
    """Annotated frames of the recording, in order."""
    return sorted({item.frame for item in annotations.items if item.frame < sequence.frame_count})


def count_nail_images(sequence: Sequence, annotations: Annotations, step: int = 1) -> int:
    """How many images `annotated_nail_images` takes at most."""
    frames = set(list_frames(sequence, annotations)[::step])
    return len({(item.frame, item.camera) for item in annotations.items if item.frame in frames})


def _cut_out_all(sequence: Sequence, frame: int, by_hand: dict[str, list[Annotation]]) -> Iterator[AnnotatedImage]:
    """The images of one moment, with the hands that can be fitted to their marks."""
    fitted = {hand: _fit(sequence, hand, items) for hand, items in by_hand.items()}
    poses = {hand: pose for hand, pose in fitted.items() if pose is not None}
    if not poses:
        return
    scene = Scene(tuple(default_hand(hand) for hand in poses))
    posed, places = scene.pose_at(np.concatenate(list(poses.values()))), NailPlaces.of(scene)
    marks = [{item.camera: item for item in reversed(by_hand[hand])} for hand in poses]
    for camera_id in sorted(set().union(*marks)):
        found = _cut_out(sequence, frame, camera_id, posed, places, [own.get(camera_id) for own in marks])
        if found is not None:
            yield found


def _fit(sequence: Sequence, hand: str, items: list[Annotation]) -> Array | None:
    """(D,) pose of the default hand on its marked joints; None where the views do not agree."""
    model = default_hand(hand)
    if len(items) == 1:
        camera = sequence.camera(items[0].camera)
        return start_hand(model, undistort_points(items[0].points, camera), camera, None, STEPS)
    seen = []
    for item in items:
        points = np.where(item.points[:, 2:] > 0, item.points[:, :2], np.nan)
        seen.append({hand: DetectedHand(points, np.zeros((21, 3)), 1.0, float(hand == "right"))})
    cameras = tuple(sequence.camera(item.camera) for item in items)
    return place_in_views(model, hand, ViewHands(cameras, tuple(seen)))


def _cut_out(
    sequence: Sequence,
    frame: int,
    camera_id: str,
    posed: PosedScene,
    places: NailPlaces,
    marks: list[Annotation | None],
) -> AnnotatedImage | None:
    recorded = sequence.camera(camera_id)
    image, camera = undistort(Frame(frame, camera_id, brighten(sequence.color(frame, camera_id)), None), recorded)
    assert image.color is not None
    view = draw_nail_view(posed, places, camera, image.color)
    if view is None:
        return None
    is_marked = []
    for index, item in enumerate(marks):
        if item is None:
            is_marked.append(np.zeros(len(TIPS), dtype=bool))
            continue
        tips = posed.landmarks(index)[TIPS]
        depth = ((tips - camera.T_world_camera[:3, 3]) @ camera.T_world_camera[:3, 2]).clip(1e-3)
        own = undistort_points(item.points, recorded)[TIPS]
        apart = np.linalg.norm(camera.project(tips) - own[:, :2], axis=1) * depth / camera.K[0, 0]
        is_marked.append((own[:, 2] == VISIBLE) & (apart < NEAR))
    pixels = camera.project(places.points(posed.vertices))
    first = np.array([view.region.column, view.region.row])
    known = np.concatenate(is_marked)
    is_visible = view.is_visible & known
    kept = is_visible | ~known | places.find_flat(posed.vertices, camera)
    name = f"{sequence.name}, frame {frame}"
    return AnnotatedImage(name, view.region, view.image, (pixels - first)[kept], is_visible[kept])
