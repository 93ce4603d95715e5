"""Write a performance as a recording folder, with everything that is exactly known of it."""

from __future__ import annotations

import logging
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import cv2
import numpy as np
import trimesh

from tracker.capture.annotations import Annotation, save_annotations
from tracker.capture.camera import Camera
from tracker.capture.frame_pattern import FramePattern
from tracker.capture.recorded_camera import RecordedCamera
from tracker.capture.recorded_object import RecordedObject
from tracker.capture.sequence import TRUTH_FILE, Sequence, load_sequence, save_sequence_json
from tracker.capture.truth import Truth
from tracker.errors import SequenceError
from tracker.model.articulated import ArticulatedModel
from tracker.synthesis.actor import Actor
from tracker.synthesis.performance import Moment, Performance, render_moment
from tracker.synthesis.sensor import StructuredLight
from tracker.synthesis.shading import compute_cosines, shade
from tracker.synthesis.texture import Texture
from tracker.synthesis.view_noise import ViewNoise, disturb_image
from tracker.synthesis.visibility import find_visibility

log = logging.getLogger(__name__)

SaveModel = Callable[[ArticulatedModel, Path], None]


DISCS = 3
"""Stream of chance of the discs."""


@dataclass(frozen=True)
class RecordingOptions:
    """How a performance is recorded.

    Attributes:
        moments: Which moments of the performance become frames, in order.
        sensor: Noise of the depth camera; None for exact images.
        seed: Of the noise. The noise of a moment depends on the seed and the moment only, not on what else is recorded.
        background: Depth of a wall behind everything, m; 0 for none.
        texture: Of skin and walls in the colour images, which then have the noise of a camera; None leaves them plain.
        view_noise: Discs in the colour images; None for none. Annotations stay exact.
    """

    moments: range
    sensor: StructuredLight | None = field(default_factory=StructuredLight)
    seed: int = 0
    background: float = 0.0
    texture: Texture | None = None
    view_noise: ViewNoise | None = None

    @property
    def depth_scale(self) -> float:
        """m per unit: a sensor of the Carmine kind reports whole millimetres; exact images keep tenths of them."""
        return 0.001 if self.sensor is not None else 0.0001


def write_recording(
    performance: Performance,
    folder: Path,
    options: RecordingOptions,
    save_model: SaveModel,
    progress: Callable[[float], None] = lambda share: None,
) -> Sequence:
    """Render a performance to a recording folder with `truth.npz`, annotations of every frame and the models.

    The folder appears whole or not at all; it must not exist before.

    Args:
        performance: What to render.
        folder: Where to.
        options: Which moments, and how.
        save_model: Writes a model to an npz file.
        progress: Told the share that is done, 0 to 1.
    """
    assert len(options.moments) > 0
    with _appearing(folder) as unfinished:
        cameras = tuple(_recorded_camera(camera, number, options) for number, camera in enumerate(performance.cameras))
        _make_folders(unfinished, cameras, performance)
        truth = _render(performance, cameras, unfinished, options, progress)
        truth.save(unfinished / TRUTH_FILE)
        save_annotations(unfinished / "annotations.json", _annotate(performance, truth))
        for actor in performance.hands:
            save_model(actor.model, unfinished / "models" / f"{actor.name}.npz")
        objects = tuple(_write_object(actor, truth, unfinished, save_model) for actor in performance.objects)
        save_sequence_json(
            Sequence(
                folder=unfinished,
                name=performance.name,
                fps=performance.fps / options.moments.step,
                frame_count=len(options.moments),
                cameras=cameras,
                hands=tuple(actor.name for actor in performance.hands),
                objects=objects,
                annotations="annotations.json",
            )
        )
    log.info("wrote %d frames of %s to %s", len(options.moments), performance.name, folder)
    return load_sequence(folder)


def _make_folders(folder: Path, cameras: tuple[RecordedCamera, ...], performance: Performance) -> None:
    for name in ("models", *(["objects"] if performance.objects else [])):
        (folder / name).mkdir()
    for camera in cameras:
        for pattern in (camera.color, camera.depth):
            assert pattern is not None
            (folder / pattern.path(0)).parent.mkdir(parents=True)


def _render(
    performance: Performance,
    cameras: tuple[RecordedCamera, ...],
    folder: Path,
    options: RecordingOptions,
    progress: Callable[[float], None],
) -> Truth:
    """Write every image of every moment; what is exactly known of them."""
    views = [performance.seen_by(camera) for camera in cameras]
    moments = []
    for frame, index in enumerate(options.moments):
        seen = [render_moment(view, index) for view in views]
        for number, (view, moment) in enumerate(zip(views, seen, strict=True)):
            _write_images(view, moment, number, frame, folder, options)
        visibility = [find_visibility(view, moment) for view, moment in zip(views, seen, strict=True)]
        moments.append((seen[0].joints, [moment.pixels for moment in seen], visibility))
        progress((frame + 1) / len(options.moments))
    joints, pixels, visibility = (np.array(column) for column in zip(*moments, strict=True))
    return Truth(
        frame=np.arange(len(options.moments)),
        source_frame=np.array(options.moments),
        joint_names=performance.joint_names,
        joints_3d=joints,
        joints_2d=pixels,
        visibility=visibility,
        object_names=tuple(actor.name for actor in performance.objects),
        T_world_object=_object_motion(performance, options.moments),
    )


def _recorded_camera(camera: Camera, number: int, options: RecordingOptions) -> RecordedCamera:
    """The first camera's images lie in `color` and `depth`, those of every other in a folder of its own."""
    home = f"{camera.id}/" if number else ""
    return RecordedCamera(
        id=camera.id,
        width=camera.width,
        height=camera.height,
        K=camera.K,
        T_world_camera=camera.T_world_camera,
        color=FramePattern(f"{home}color/", 6, ".png"),
        depth=FramePattern(f"{home}depth/", 6, ".png"),
        depth_scale=options.depth_scale,
    )


def _write_images(
    performance: Performance, moment: Moment, number: int, frame: int, folder: Path, options: RecordingOptions
) -> None:
    """What the camera of this number sees; a performance before it alone."""
    seed = [options.seed, moment.index, *([number] if number else [])]
    is_noisy = options.sensor is not None or options.texture is not None
    rng = np.random.default_rng(seed) if is_noisy else None
    cosines = compute_cosines(performance, moment)
    if options.texture is None:
        color = shade(performance, moment, cosines, rng)
    else:
        color = options.texture.shade(performance, moment, rng)
    if options.view_noise is not None:
        color, _ = disturb_image(color, options.view_noise, np.random.default_rng([*seed, number, DISCS]))
    depth = moment.depth
    if options.background > 0.0:
        is_empty = moment.face < 0
        depth = np.where(is_empty, options.background, depth)
        cosines = np.where(is_empty, 1.0, cosines)
    if options.sensor is not None and rng is not None:
        depth = options.sensor.measure(depth, cosines, performance.camera.K[0, 0], rng)
    units = np.clip(np.rint(depth / options.depth_scale), 0, np.iinfo(np.uint16).max).astype(np.uint16)
    fast = [cv2.IMWRITE_PNG_COMPRESSION, 3]
    camera = performance.camera
    assert isinstance(camera, RecordedCamera) and camera.color is not None and camera.depth is not None
    for pattern, image in ((camera.color, cv2.cvtColor(color, cv2.COLOR_RGB2BGR)), (camera.depth, units)):
        path = folder / pattern.path(frame)
        if not cv2.imwrite(str(path), image, fast):
            raise SequenceError(f"{path}: the image could not be written; is the disk full?")


def _annotate(performance: Performance, truth: Truth) -> list[Annotation]:
    """The true joints of every hand in every frame as annotations; a joint outside the image is absent."""
    items = []
    for hand in performance.hands:
        own = [truth.joint_names.index(name) for name in hand.joint_names]
        for frame in truth.frame:
            for number, camera in enumerate(performance.cameras):
                visibility = truth.visibility[frame, number, own]
                points = np.column_stack([truth.joints_2d[frame, number, own], visibility.astype(np.float64)])
                points[visibility == 0] = 0.0
                items.append(Annotation(int(frame), camera.id, hand.name, points))
    return items


def _object_motion(performance: Performance, moments: range) -> np.ndarray:
    """(T, O, 4, 4) coordinates of each object's file to world, m."""
    motion = [[actor.T_world_model(index) for actor in performance.objects] for index in moments]
    return np.array(motion, dtype=np.float64).reshape(len(moments), len(performance.objects), 4, 4)


def _write_object(actor: Actor, truth: Truth, folder: Path, save_model: SaveModel) -> RecordedObject:
    """The object's file, rigid as a PLY in its own coordinates, articulated as an npz, and where it is at first."""
    T_world_object = truth.T_world_object[0, truth.object_names.index(actor.name)]
    bones = actor.model.skeleton.bone_names
    if len(bones) == 1:
        path = f"objects/{actor.name}.ply"
        trimesh.Trimesh(actor.model.vertices, actor.model.faces, process=False).export(str(folder / path))
        return RecordedObject(actor.name, path, T_world_object)
    path = f"objects/{actor.name}.npz"
    save_model(actor.model, folder / path)
    own = [truth.joint_names.index(name) for name in actor.joint_names]
    return RecordedObject(actor.name, path, T_world_object, dict(zip(bones, truth.joints_3d[0, own], strict=True)))


@contextmanager
def _appearing(folder: Path) -> Iterator[Path]:
    """A temporary folder beside `folder` that becomes it if all goes well and is removed otherwise."""
    if folder.exists():
        raise SequenceError(f"{folder}: is already there; name a new folder or remove it first.")
    folder.parent.mkdir(parents=True, exist_ok=True)
    unfinished = Path(tempfile.mkdtemp(prefix=f".{folder.name[:100]}.", dir=folder.parent))
    try:
        unfinished.chmod(0o755)
        yield unfinished
        os.rename(unfinished, folder)
    finally:
        shutil.rmtree(unfinished, ignore_errors=True)
