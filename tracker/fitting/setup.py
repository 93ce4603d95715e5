"""What stays the same during a tracking run: models, camera and options."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.camera import Camera
from tracker.capture.exposure import brighten, brighten_frame
from tracker.capture.frame import CameraFrame, Frame
from tracker.capture.sequence import Sequence
from tracker.detection import Forest, OwnDetector, load_detector, save_forest
from tracker.detection.default_detector import default_detector
from tracker.errors import TrackingError, reading
from tracker.fitting.map_views import map_views
from tracker.fitting.options import TrackOptions
from tracker.fitting.tracking_faults import find_tracking_faults
from tracker.landmarks import HandDetector, default_hand_detector
from tracker.model.articulated import ArticulatedModel
from tracker.model.joints import HAND_JOINTS
from tracker.model.npz_files import load_npz_model, save_npz_model
from tracker.model.scene import Scene
from tracker.observation import Preprocessing, undistort
from tracker.physics import PhysicsWorld, StaticScene, find_down

FINGERTIPS = "fingertips.npz"


@dataclass(frozen=True)
class TrackSetup:
    """Models and options of a run.

    Attributes:
        names: Of the models: `right`, `left` or an object's name.
        models: As they are tracked, calibrated.
        camera_id: The depth camera; of several cameras that are tracked in together the first one with depth, else
            the first.
        options: What the user chose.
        marks: Name of a hand to its joints (21, 3) as marked in the first frame, px of an ideal lens and v.
        own_detector: Finds fingertips for the S of [T16] Eq. 5, in colour views finger nails (§3.3); None for the
            bundled detector, in colour views for none.
        static_scene: Planes and gravity; None where the run was begun without an object, or before they were kept.
        view_ids: The cameras that are tracked in together; none where one depth camera is.
    """

    names: tuple[str, ...]
    models: tuple[ArticulatedModel, ...]
    camera_id: str
    options: TrackOptions
    marks: dict[str, npt.NDArray[np.float64]] = field(default_factory=dict)
    own_detector: OwnDetector | None = None
    static_scene: StaticScene | None = None
    view_ids: tuple[str, ...] = ()

    @cached_property
    def scene(self) -> Scene:
        return Scene(self.models)

    @cached_property
    def hands(self) -> tuple[int, ...]:
        """Indices of the hands among the models."""
        return tuple(index for index, model in enumerate(self.models) if model.hand is not None)

    @cached_property
    def objects(self) -> tuple[int, ...]:
        """Indices of the objects."""
        return tuple(index for index, model in enumerate(self.models) if model.hand is None)

    @property
    def preprocessing(self) -> Preprocessing:
        return Preprocessing(use_skin=self.options.use_skin, objects=bool(self.objects))

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Of the joints of a track: `right/index_mcp` for hands, `rope:<bone>` for articulated objects."""
        names: list[str] = []
        for name, model in zip(self.names, self.models, strict=True):
            if model.hand:
                names += [f"{name}/{joint}" for joint in HAND_JOINTS]
            elif model.skeleton.num_bones > 1:
                names += [f"{name}:{bone}" for bone in model.skeleton.bone_names]
        return tuple(names)

    @property
    def hand_names(self) -> tuple[str, ...]:
        return tuple(self.names[hand] for hand in self.hands)

    @property
    def hand_detector(self) -> HandDetector | None:
        """Finds the hands in colour images; None where the user does without."""
        return default_hand_detector() if self.options.use_detector else None

    @property
    def is_distance_guessed(self) -> bool:
        """Whether nothing but the model's size tells how far away the hands are: one colour camera without depth."""
        return len(self.view_ids) == 1

    @property
    def fingertip_detector(self) -> Forest:
        """The one that was given, or the bundled one."""
        return self.own_detector.forest if self.own_detector else default_detector()

    @property
    def nail_detector(self) -> Forest | None:
        """What finds finger nails in colour views; None where nobody gave one."""
        return self.own_detector.forest if self.own_detector and self.view_ids else None

    @property
    def object_names(self) -> tuple[str, ...]:
        return tuple(self.names[index] for index in self.objects)

    def make_world(self, T_world_camera: npt.NDArray[np.float64]) -> PhysicsWorld:
        """A physics world with the run's static scene; where it has none, things fall along +y of the camera (4, 4)."""
        static = self.static_scene or StaticScene(find_down(T_world_camera))
        return PhysicsWorld(self.scene, down=static.down, planes=static.planes)

    def read(self, sequence: Sequence, index: int) -> tuple[Frame, Camera]:
        """A frame as an ideal pinhole camera sees it, and that camera."""
        return undistort(brighten_frame(sequence.frame(index, self.camera_id)), sequence.camera(self.camera_id))

    def project_hands(self, pose: npt.NDArray[np.float64], camera: Camera) -> dict[str, npt.NDArray[np.float64]]:
        """Name of each hand that is before a camera to its joints (21, 2) px at a pose (D,)."""
        posed = self.scene.pose_at(pose)
        joints = {self.names[hand]: camera.project(posed.landmarks(hand)) for hand in self.hands}
        return {name: points for name, points in joints.items() if np.all(np.isfinite(points))}

    def read_views(self, sequence: Sequence, index: int, threads: int = 1) -> list[CameraFrame]:
        """The frames of all views: as recorded, those with depth as ideal pinhole cameras see them.

        Args:
            sequence: The recording.
            index: Of the moment.
            threads: In which the images are read.
        """

        def read(camera_id: str) -> CameraFrame:
            camera = sequence.camera(camera_id)
            if camera.has_depth and self.options.use_depth:
                frame, ideal = undistort(brighten_frame(sequence.frame(index, camera_id)), camera)
                return CameraFrame(ideal, frame)
            return CameraFrame(camera, Frame(index, camera_id, brighten(sequence.color(index, camera_id)), None))

        return map_views(read, self.view_ids, threads)

    def save(self, folder: Path) -> None:
        """Write `setup.json`, `models/<name>.npz`, and `fingertips.npz` where a detector was given."""
        folder = Path(folder)
        (folder / "models").mkdir(parents=True, exist_ok=True)
        for name, model in zip(self.names, self.models, strict=True):
            save_npz_model(model, folder / "models" / f"{name}.npz")
        document = {
            "version": 1,
            "names": list(self.names),
            "camera": self.camera_id,
            "views": list(self.view_ids),
            "options": self.options.to_json(),
            "marks": {name: points.tolist() for name, points in self.marks.items()},
        }
        if self.own_detector is not None:
            save_forest(self.own_detector.forest, folder / FINGERTIPS)
            document["detector"] = self.own_detector.to_json()
        if self.static_scene is not None:
            document["static_scene"] = self.static_scene.to_json()
        temporary = folder / ".setup.json.part"
        temporary.write_text(json.dumps(document, indent=1))
        temporary.replace(folder / "setup.json")

    @classmethod
    def load(cls, folder: Path) -> TrackSetup:
        """Read what `save` wrote."""
        folder = Path(folder)
        with reading(TrackingError, folder, "setup.json as a tracking run writes it"):
            document = json.loads((folder / "setup.json").read_text())
            names = tuple(str(name) for name in document["names"])
            camera, options = str(document["camera"]), TrackOptions.from_json(document["options"])
            views = tuple(str(camera_id) for camera_id in document.get("views", ()))
            static = document.get("static_scene")
            static_scene = None if static is None else StaticScene.from_json(static)
            called = document.get("detector")  # tracks of before it was kept have the file alone
            told = {} if called is None else {name: str(called[name]) for name in ("name", "sha256")}
            marks = {str(n): np.array(p, dtype=np.float64).reshape(21, 3) for n, p in document["marks"].items()}
        models = tuple(load_npz_model(folder / "models" / f"{name}.npz") for name in names)
        detector = load_detector(folder / FINGERTIPS) if (folder / FINGERTIPS).exists() else None
        if detector is not None:
            detector = replace(detector, **told)
        return cls(names, models, camera, options, marks, detector, static_scene, views)


def choose_cameras(sequence: Sequence, options: TrackOptions) -> tuple[str, tuple[str, ...]]:
    """The depth camera that a run tracks in and no views, or the main one of its views and all of them.

    Raises:
        TrackingError: The recording cannot be tracked so.
    """
    with_depth = [camera.id for camera in sequence.cameras if camera.has_depth]
    with_color = [camera.id for camera in sequence.cameras if camera.has_color]
    faults = find_tracking_faults(sequence.frame_count, sequence.hands, with_depth, with_color, options)
    if faults:
        raise TrackingError(f"{sequence.name}: {' '.join(faults)}")
    if with_depth and not options.view_ids:
        return options.camera or with_depth[0], ()
    views = options.view_ids or tuple(with_color)
    deep = [camera_id for camera_id in views if camera_id in with_depth and options.use_depth]
    return (deep or views)[0], () if deep and len(views) == 1 else views
