"""A real recording and the joints that people marked in it, in two passes."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from benchmarks.real_marks.stereo_depth import make_recording
from tracker.capture.annotations import Annotations, load_annotations
from tracker.capture.import_options import ImportOptions
from tracker.capture.import_run import run_import
from tracker.capture.sequence import Sequence, load_sequence
from tracker.model.joints import HAND_JOINTS

Array = npt.NDArray[np.float64]

FOLDER = Path(__file__).parent / "recordings"
"""One folder a recording: `recording.json`, `marks_1.json` and `marks_2.json`. A folder more is a recording more."""

TIPS = [index for index, joint in enumerate(HAND_JOINTS) if joint.endswith("_tip")]


@dataclass(frozen=True)
class MarkedRecording:
    """A recording with marks.

    Attributes:
        name: Of its folder.
        about: `source` in the data folder, how to read it (`kind`), its hand, `right_within_px`, up to which a joint
            counts as right, and `whole`, first and last frame of each stretch that shows the hand whole, all where it
            is missing; `holds`: `ball` where a ball is held.
        passes: What was marked the first and the second time.
    """

    name: str
    about: Mapping[str, object]
    passes: tuple[Annotations, Annotations]

    @classmethod
    def load(cls, folder: Path) -> MarkedRecording:
        about = json.loads((folder / "recording.json").read_text())
        first, second = (load_annotations(folder / f"marks_{number}.json") for number in (1, 2))
        return cls(folder.name, about, (first, second))

    @property
    def hand(self) -> str:
        return str(self.about["hand"])

    @property
    def limit(self) -> float:
        """px."""
        return float(str(self.about["right_within_px"]))

    def list_whole(self, count: int) -> set[int]:
        """Of `count` frames, those in which no part of the hand is cut off by the image."""
        stretches: list[list[int]] = self.about.get("whole", [[0, count - 1]])  # type: ignore[assignment]
        return {frame for first, last in stretches for frame in range(first, last + 1)}

    @property
    def has_depth(self) -> bool:
        return self.about["kind"] != "video"

    def source(self, data: Path) -> Path:
        return data / str(self.about["source"])

    def read(self, data: Path, work: Path) -> Sequence:
        """Import it into a folder of its name; what was imported before is taken as it is."""
        out = work / self.name
        if (out / "sequence.json").exists():
            return load_sequence(out)
        if self.about["kind"] == "stereo_pair":
            return make_recording(self.source(data), int(str(self.about["camera"])), out)
        facts = {name: self.about[name] for name in ("fps", "fx", "fy", "cx", "cy", "depth_scale")}
        run_import(self.source(data), out, "rgbd_folder", ImportOptions(**facts, hands=(self.hand,)))  # type: ignore[arg-type]
        return load_sequence(out)

    def images(self, data: Path) -> list[npt.NDArray[np.uint8]]:
        """All images, red green blue, of a recording without depth."""
        video, images = cv2.VideoCapture(str(self.source(data))), []
        while True:
            is_there, image = video.read()
            if not is_there:
                return images
            images.append(image[..., ::-1].astype(np.uint8))

    @cached_property
    def marks(self) -> dict[int, Array]:
        """Frame to its marks (21, 2) px, the mean of both passes; NaN where one has none or they are apart."""
        found = {}
        for frame in sorted({item.frame for item in self.passes[0].items}):
            first, second = self.points(0, frame), self.points(1, frame)
            is_same = np.linalg.norm(first - second, axis=1) <= self.limit
            found[frame] = np.where(is_same[:, None], 0.5 * (first + second), np.nan)
        return found

    def measure_passes(self) -> Array:
        """(N,) px between the two passes, of every joint that both have."""
        frames = sorted({item.frame for item in self.passes[0].items})
        apart = [np.linalg.norm(self.points(0, frame) - self.points(1, frame), axis=1) for frame in frames]
        joined = np.concatenate(apart)
        return joined[np.isfinite(joined)]

    def points(self, number: int, frame: int) -> Array:
        """(21, 2) px of one pass, NaN where nothing is marked."""
        item = next((item for item in self.passes[number].items if item.frame == frame), None)
        if item is None:
            return np.full((21, 2), np.nan)
        return np.where(item.points[:, 2:] > 0, item.points[:, :2], np.nan)


def load_marked_recordings(data: Path, only: list[str] | None = None) -> list[MarkedRecording]:
    """Those whose data is there."""
    folders = sorted(folder for folder in FOLDER.iterdir() if (folder / "recording.json").exists())
    found = [MarkedRecording.load(folder) for folder in folders if only is None or folder.name in only]
    return [recording for recording in found if recording.source(data).exists()]
