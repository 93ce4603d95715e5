"""A folder of scans of one moving person, registered frame by frame; a stopped run continues."""

from __future__ import annotations

import json
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.bodies.body_registration import (
    BODY_FILE,
    BodyRegistration,
    load_body_registration,
    save_body_registration,
)
from tracker.bodies.body_scan_file import load_body_scan
from tracker.bodies.chunks import cut_chunks, find_start, follow_chunk, join_chunk
from tracker.bodies.follow_body import BodyFollower, FollowOptions
from tracker.bodies.register_body import Registrar
from tracker.bodies.template import (
    choose_template_frames,
    find_shape,
    make_own_model,
    register_for_template,
)
from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan import Scan
from tracker.errors import RegistrationError, ScanError, TrackerError
from tracker.model.blend_files import load_blend_model, save_blend_model
from tracker.model.blend_model import BlendModel
from tracker.model.body_motion import BodyMotion, save_body_motion

TEMPLATE, SETTINGS, SUMMARY, MOTION = "template.npz", "settings.json", "summary.json", "motion.npz"
FRAMES, TEMPLATES = "frames", "template"

Progress = Callable[[float, str], None]


@dataclass(frozen=True)
class SequenceOptions:
    """How a sequence is registered.

    Attributes:
        follow: How a frame follows from the one before.
        template_frames: So many frames make the person's template, spread over the first `template_span`.
        template_span: [R17] 4.3: the first 50, in which the person is mostly still.
        chunk: Frames of a chunk: chunks are registered in parallel and then joined; all frames when 0.
        metres_per_unit: Of the files; told by the size when left out.
        fps: Frames per second.
    """

    follow: FollowOptions = field(default_factory=FollowOptions)
    template_frames: int = 6
    template_span: int = 50
    chunk: int = 0
    metres_per_unit: float | None = None
    fps: float = 60.0


@dataclass(frozen=True)
class Sequence:
    """Scans in the order of their names, the folder they are registered into, and how."""

    paths: tuple[Path, ...]
    out: Path
    options: SequenceOptions

    def __len__(self) -> int:
        return len(self.paths)

    def folder(self, frame: int) -> Path:
        return self.out / FRAMES / f"{frame:06d}"

    def error_file(self, frame: int) -> Path:
        """Why a frame's scan could not be read."""
        return self.out / FRAMES / f"{frame:06d}.error"

    @property
    def chunks(self) -> list[range]:
        return cut_chunks(0, len(self), self.options.chunk)


class SequenceFrames:
    """Frames of a sequence as files: what `tracker.bodies.chunks.KeptFrames` asks for."""

    def __init__(self, sequence: Sequence, faces: npt.NDArray) -> None:
        self._sequence, self._faces = sequence, faces

    def read(self, frame: int) -> Scan:
        return load_body_scan(self._sequence.paths[frame], self._sequence.options.metres_per_unit)[0]

    def load(self, frame: int) -> BodyRegistration | None:
        folder = self._sequence.folder(frame)
        if not (folder / BODY_FILE).is_file():
            return None
        try:
            return load_body_registration(folder)
        except RegistrationError:
            return None  # damaged: made anew

    def keep(self, frame: int, registration: BodyRegistration) -> None:
        save_body_registration(registration, self._faces, self._sequence.folder(frame))

    def leave_out(self, frame: int, error: TrackerError) -> None:
        path = self._sequence.error_file(frame)
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomically(path, str(error).encode())

    def begin(self, follower: BodyFollower, frame: int, scan: Scan) -> BodyRegistration:
        """From what the template was made of, where it was, else without a start."""
        folder = self._sequence.out / TEMPLATES / f"{frame:06d}"
        known = load_body_registration(folder) if (folder / BODY_FILE).is_file() else None
        return follower.begin(scan, find_start(known))


def register_sequence(
    sequence: Sequence, model: BlendModel, processes: int = 1, progress: Progress | None = None
) -> dict[str, Any]:
    """Register every frame; what `progress` raises ends the work, and the same call goes on behind the last frame.

    A scan that cannot be read is named in the summary, and the next frame follows from the one before it.

    Args:
        sequence: The scans.
        model: A body; its template is replaced by the person's.
        processes: Chunks at a time.
        progress: Is told the share that is done and the frame.

    Returns:
        What `summary.json` holds.

    Raises:
        TrackerError: The folder holds a sequence that was registered otherwise, or no frame can be registered.
    """
    tell = progress or (lambda share, detail: None)
    _check_settings(sequence)
    frames = SequenceFrames(sequence, model.faces)
    own = _own_model(sequence, frames, model, tell)
    follower = BodyFollower(own, sequence.options.follow)
    chunks = sequence.chunks
    if processes == 1 or len(chunks) == 1:
        for chunk in chunks:
            for frame in follow_chunk(frames, follower, chunk):
                tell(0.1 + 0.85 * (frame + 1) / len(sequence), f"frame {frame}")
    else:
        with ProcessPoolExecutor(processes) as pool:
            jobs = [(sequence, own, chunk) for chunk in chunks]
            try:
                for number, _ in enumerate(pool.map(_run_chunk, jobs)):
                    tell(0.1 + 0.85 * (number + 1) / len(chunks), f"chunk {number}")
            except BaseException:
                pool.shutdown(wait=False, cancel_futures=True)
                raise
    for number in range(1, len(chunks)):
        join_chunk(frames, follower, chunks, number)
    tell(1.0, "done")
    return _write_results(sequence, frames, own, find_shape(model, own))


def _run_chunk(job: tuple[Sequence, BlendModel, range]) -> None:
    sequence, model, chunk = job
    follower = BodyFollower(model, sequence.options.follow)
    for _ in follow_chunk(SequenceFrames(sequence, model.faces), follower, chunk):
        pass


def _own_model(sequence: Sequence, frames: SequenceFrames, model: BlendModel, tell: Progress) -> BlendModel:
    """The person's own model; made once and kept."""
    path = sequence.out / TEMPLATE
    if path.is_file():
        return load_blend_model(path)
    registrar: Registrar | None = None
    chosen = choose_template_frames(
        range(len(sequence)), sequence.options.template_frames, sequence.options.template_span
    )
    found: list[BodyRegistration] = []
    for number, frame in enumerate(chosen):
        tell(0.1 * number / len(chosen), f"template, frame {frame}")
        folder = sequence.out / TEMPLATES / f"{frame:06d}"
        if (folder / BODY_FILE).is_file():
            found.append(load_body_registration(folder))
            continue
        try:
            scan = frames.read(frame)
        except ScanError as error:
            frames.leave_out(frame, error)
            continue
        registrar = registrar or Registrar(model)
        found.append(register_for_template(registrar, scan, found[-1] if found else None))
        save_body_registration(found[-1], model.faces, folder)
    save_blend_model(make_own_model(model, found), path)
    return load_blend_model(path)  # as a run that goes on reads it: to the last bit the same


def _check_settings(sequence: Sequence) -> None:
    """Keep what the folder was begun with; refuse another sequence in it."""
    settings = {"scans": [str(path) for path in sequence.paths], "options": asdict(sequence.options)}
    path = sequence.out / SETTINGS
    sequence.out.mkdir(parents=True, exist_ok=True)
    try:
        earlier = json.loads(path.read_text())
    except (OSError, ValueError):
        earlier = None
    if earlier is None:
        write_atomically(path, json.dumps(settings).encode())
    elif earlier != json.loads(json.dumps(settings)):
        raise TrackerError(f"{sequence.out} holds a sequence of other scans or options; choose another folder.")


def _write_results(
    sequence: Sequence, frames: SequenceFrames, model: BlendModel, shape: npt.NDArray[np.float64]
) -> dict[str, Any]:
    """`motion.npz` and `summary.json`; frames without a registration keep the pose of the one before."""
    found = [frames.load(frame) for frame in range(len(sequence))]
    known = [each for each in found if each is not None]
    if not known:
        raise TrackerError(f"None of {len(sequence)} scans could be registered.")
    _write_motion(sequence, found, known[0], shape)
    unread = [sequence.error_file(frame) for frame, each in enumerate(found) if each is None]
    summary = {
        "frames": len(sequence),
        "registered": len(known),
        "errors": [path.read_text() for path in unread if path.is_file()],
        "verdicts": {name: sum(each.verdict == name for each in known) for name in ("good", "doubtful", "bad")},
        "guessed": {
            side: [frame for frame, each in enumerate(found) if each is not None and not each.are_shown[k]]
            for k, side in enumerate(("left", "right"))
        },
        "scan_to_mesh_mm": float(np.mean([each.summary()["scan_to_mesh_mm"]["mean"] for each in known])),
        "median_seconds": float(np.median([sum(each.seconds.values()) for each in known])),
        "vertices": len(model.template),
    }
    write_atomically(sequence.out / SUMMARY, json.dumps(summary, indent=1).encode())
    return summary


def _write_motion(
    sequence: Sequence, found: list[BodyRegistration | None], first: BodyRegistration, shape: npt.NDArray[np.float64]
) -> None:
    states = [first.state]
    for each in found:
        states.append(each.state if each else states[-1])
    poses = np.array([state.pose for state in states[1:]])
    places = np.array([state.translation for state in states[1:]])
    save_body_motion(BodyMotion(poses, places, shape, sequence.options.fps), sequence.out / MOTION)
