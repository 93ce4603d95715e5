"""Begin a run: place every hand and object in the first frame and calibrate the hands."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotations
from tracker.capture.sequence import Sequence
from tracker.capture.stopped_camera import check_cameras_last
from tracker.detection import OwnDetector
from tracker.errors import TrackingError
from tracker.fitting.attempt import look
from tracker.fitting.calibration import propose_shapes
from tracker.fitting.frame_fit import FitOptions, draw, fit_frame
from tracker.fitting.measure_quality import measure_quality
from tracker.fitting.objective import Objective
from tracker.fitting.options import TrackOptions
from tracker.fitting.region import depth_range, whole_image
from tracker.fitting.setup import TrackSetup, choose_cameras
from tracker.fitting.sighting import Sightings, find_sightings
from tracker.fitting.tracking_faults import find_detector_faults
from tracker.landmarks import default_hand_detector
from tracker.model.articulated import ArticulatedModel
from tracker.model.default_hand import default_hand
from tracker.model.files import load_model
from tracker.model.scene import Scene
from tracker.model.shape import with_shape
from tracker.observation import observe
from tracker.search.leave_out import leave_out
from tracker.search.mirrored_views import check_mirrored
from tracker.search.seen_hands import place_where_seen
from tracker.search.start_annotated import start_hand, undistort_points, with_marks
from tracker.search.start_automatic import find_hand
from tracker.search.start_object import start_object
from tracker.tracking.calibration_run import calibrate_hands
from tracker.tracking.start_plan import plan_start
from tracker.tracking.start_views import start_views
from tracker.tracking.state import TrackState
from tracker.tracking.static_scene import see_static_scene

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]
Placed = tuple[ArticulatedModel, Array]
"""A model and its pose (D,) in the first frame; zeros where it was not found."""

MIN_MARKED = 6
"""With fewer marked joints a hand is looked for in the depth alone."""

SIZE_GAIN = 0.02
"""Another size is taken if it raises the merit by this."""


def start_tracking(
    sequence: Sequence,
    options: TrackOptions,
    models: dict[str, ArticulatedModel] | None = None,
    annotations: Annotations | None = None,
    progress: Progress | None = None,
    detector: OwnDetector | None = None,
) -> tuple[TrackSetup, TrackState]:
    """Place the hands in the first frame, from its annotation, the hand detector or the depth alone, and calibrate.

    Args:
        sequence: The recording.
        options: What the user chose.
        models: Hands, `right` and `left`, to use in place of the default ones, and objects in place of the recording's.
        annotations: Only those of the first frame are looked at.
        progress: Called with the stage and the share that is done, 0 to 1; may raise to cancel.
        detector: Finds fingertips in every frame, in colour views finger nails, for terms with S; None for the
            bundled one.

    Raises:
        TrackingError: `find_tracking_faults` or `find_detector_faults` finds some, a camera is mirrored, or an object
            is not found.
        FrameError: A camera stopped before the last frame.
    """
    camera_id, view_ids = choose_cameras(sequence, options)
    if detector is not None:
        _check_detector(detector, sequence, None if view_ids else camera_id, options)
    tell = progress or (lambda stage, share: None)
    hands, objects = _load_models(sequence, models or {}, options)
    models = hands | objects
    frames = options.frame_range(sequence.frame_count)
    check_cameras_last(sequence, view_ids or (camera_id,), frames, options.use_depth or not view_ids)
    if view_ids:
        _check_mirrored(sequence, options, view_ids, tuple(hands), frames)
        own = tuple(models), tuple(models.values())
        setup = TrackSetup(*own, camera_id, options, own_detector=detector, view_ids=view_ids)
        return start_views(sequence, setup, frames, tell)
    marks = _find_marks(sequence, annotations, frames[0], camera_id)
    bare = TrackSetup((), (), camera_id, options, marks)
    frame, camera = bare.read(sequence, frames[0])
    sightings = find_sightings(bare.hand_detector, frame, camera, tuple(hands), {})
    # A hand that is looked for in the depth may not take the pixels of one that somebody marked or the detector sees.
    first = sorted(hands, key=lambda hand: (hand not in marks, hand not in sightings.hands))
    tell = plan_start(sequence, options, first).share(tell)
    placed = _place_hands(sightings, bare, {name: hands[name] for name in first}, tell)
    placed |= _place_objects(sequence, bare, objects, placed, tell)
    there = tuple(name for name in models if name in objects or np.any(placed[name][1]))
    if options.calibrate:
        placed |= _calibrate(sequence, there, placed, bare, frames, tell)
    setup = TrackSetup(tuple(models), tuple(placed[name][0] for name in models), camera_id, options, marks, detector)
    pose = np.concatenate([placed[name][1] for name in models])
    if objects:
        setup = replace(setup, static_scene=see_static_scene(sequence, setup, frame, camera, pose))
    return setup, TrackState(frames[0], pose, pose, is_lost=len(there) < len(models))


def _check_detector(detector: OwnDetector, sequence: Sequence, depth_camera: str | None, options: TrackOptions) -> None:
    """Refuse a lab's own detector that does not serve; `depth_camera` is None in colour views."""
    with_color = [camera.id for camera in sequence.cameras if camera.has_color]
    forest = detector.forest
    faults = find_detector_faults(forest.kind, depth_camera, with_color, options, forest.what)
    if faults:
        raise TrackingError(f"{detector.name}: {' '.join(faults)}")


def _check_mirrored(
    sequence: Sequence, options: TrackOptions, view_ids: tuple[str, ...], hands: tuple[str, ...], frames: range
) -> None:
    """Refuse colour views of which one is mirrored, where that can be told."""
    views = [view for view in view_ids if sequence.camera(view).has_color]
    if options.use_detector and len(hands) == 1 and len(views) > 1:
        check_mirrored(sequence, views, hands[0], frames, default_hand_detector())


def _place_hands(
    sightings: Sightings, bare: TrackSetup, hands: dict[str, ArticulatedModel], tell: Progress
) -> dict[str, Placed]:
    """Hands, in this order, in the first frame; `bare` is the setup without any models."""
    placed: dict[str, Placed] = {}
    for name, model in hands.items():
        tell(f"placing the {name} hand", 0.0)
        own = {name: bare.marks[name]} if name in bare.marks else {}
        setup = replace(bare, names=(name,), models=(model,), marks=own)
        placed[name] = _begin(sightings, setup, list(placed.values()))
    return placed


def _place_objects(
    sequence: Sequence, bare: TrackSetup, objects: dict[str, ArticulatedModel], hands: dict[str, Placed], tell: Progress
) -> dict[str, Placed]:
    """Objects in the first frame, each looked for in what the hands and those before leave over."""
    placed = dict(hands)
    frames = bare.options.frame_range(sequence.frame_count)
    first_second = frames[: max(1, round(sequence.fps)) : max(1, round(sequence.fps / 6))]
    for item in sequence.objects:
        tell(f"placing {item.name}", 0.0)
        others = [(other, pose) for other, pose in placed.values() if np.any(pose)]
        views = (bare.read(sequence, index) for index in first_second)
        model = objects[item.name]
        placed[item.name] = model, start_object(model, item, views, bare.preprocessing, others)
    return placed


def _load_models(
    sequence: Sequence, given: dict[str, ArticulatedModel], options: TrackOptions
) -> tuple[dict[str, ArticulatedModel], dict[str, ArticulatedModel]]:
    """Hands and objects by name: those that were given, else the default hands and the recording's own objects."""
    hands = {name: given.get(name) or default_hand(name) for name in sequence.hands}
    objects = {
        item.name: given.get(item.name)
        or load_model(sequence.object_path(item.name), options.max_faces, item.metres_per_unit)
        for item in sequence.objects
    }
    return hands, objects


def _find_marks(sequence: Sequence, annotations: Annotations | None, index: int, camera_id: str) -> dict[str, Array]:
    """Joints (21, 3) of each hand that is marked well enough in a frame, in px of an ideal lens."""
    marks = {}
    for name in sequence.hands:
        marked = annotations.find(index, camera_id, name) if annotations else None
        if marked is not None and np.count_nonzero(marked.points[:, 2]) >= MIN_MARKED:
            marks[name] = undistort_points(marked.points, sequence.camera(camera_id))
    return marks


def _begin(sightings: Sightings, setup: TrackSetup, others: list[Placed]) -> Placed:
    """One hand of about the right size, and its pose in the first frame: zeros if nothing like a hand is there.

    `others` are hands that were placed before, with their poses; what they explain is not looked at.
    """
    base = setup.models[0]
    merit, pose = _place(sightings, setup, others)
    if pose is None:
        return base, np.zeros(base.num_dofs)
    if base.shape is None or not setup.options.calibrate:
        return base, pose
    model = base
    for shape in propose_shapes(base):
        sized = replace(setup, models=(with_shape(base, shape),))
        other_merit, other_pose = _settle(sightings, sized, pose)
        if other_merit > merit + SIZE_GAIN:
            model, pose, merit = sized.models[0], other_pose, other_merit
    return model, pose


def _calibrate(
    sequence: Sequence,
    there: tuple[str, ...],
    placed: dict[str, Placed],
    bare: TrackSetup,
    frames: range,
    tell: Progress,
) -> dict[str, Placed]:
    """Fitted model and first pose of everything that was found, by name; `bare` is the setup without any models."""
    if not any(placed[name][0].hand and placed[name][0].shape for name in there):
        return {}
    marks = {name: points for name, points in bare.marks.items() if name in there}
    setup = replace(bare, names=there, models=tuple(placed[name][0] for name in there), marks=marks)
    pose = np.concatenate([placed[name][1] for name in there])
    setup, pose = calibrate_hands(sequence, setup, frames, pose, tell)
    parts = zip(there, setup.models, setup.scene.pose_slices, strict=True)
    return {name: (model, pose[where]) for name, model, where in parts}


def _settle(sightings: Sightings, setup: TrackSetup, pose: Array) -> tuple[float, Array]:
    """Merit and pose of one hand, fitted from a pose to the depth and to the joints that were marked or seen."""
    camera = sightings.camera
    seen = look(sightings.frame, camera, setup, pose, min_pixels=0)
    if seen is None:
        return -1.0, pose
    options = FitOptions(iterations=setup.options.first_iterations, damping=1e-2)
    objective = sightings.add_to(Objective(), setup.scene, setup.names)
    objective = with_marks(objective, setup.scene, setup.names, setup.marks, camera)
    pose = fit_frame(setup.scene, seen, pose, pose, objective, options).pose
    return measure_quality(draw(setup.scene.pose_at(pose), seen), seen).merit, pose


def _place(sightings: Sightings, setup: TrackSetup, others: list[Placed]) -> tuple[float, Array | None]:
    """Merit and pose of one hand in the first frame; no pose if nothing like a hand is there."""
    frame, camera, name = sightings.frame, sightings.camera, setup.names[0]
    depths = depth_range(frame)
    if name in setup.marks:
        whole = observe(frame, camera, whole_image(camera, *depths), setup.preprocessing)
        return _settle(sightings, setup, start_hand(setup.models[0], setup.marks[name], camera, whole))
    if name in sightings.hands:
        nowhere = np.zeros(setup.scene.num_dofs)
        return _settle(sightings, setup, place_where_seen(setup, nowhere, [0], sightings))
    for other, pose in others:
        frame = leave_out(frame, camera, Scene((other,)), pose, [0])
    found = find_hand(frame, camera, setup.models[0], setup.preprocessing, *depths)
    return (-1.0, None) if found is None else (found.quality.merit, found.pose)
