"""A body registered to a scan of a person, its verdict, and its file."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tracker.bodies.body_state import BodyState
from tracker.capture.atomic_file import write_atomically
from tracker.capture.scan_ply import write_ply
from tracker.errors import RegistrationError, reads
from tracker.model.npz_arrays import NpzFields, read_foreign_npz
from tracker.model.npz_files import pack_npz
from tracker.registration.registration import summarize_distances
from tracker.registration.registration_files import MAX_COORDINATE, MAX_VERTICES

Array = npt.NDArray[np.float64]

BODY_FILE = "body.npz"
PLY_FILE = "body.ply"
NEEDED = "a body.npz that `handloom register-body` wrote"


@dataclass(frozen=True, eq=False)
class BodyRegistration:
    """A registered scan of a person.

    Attributes:
        vertices: (V, 3) the free surface, scan's frame, m.
        model_vertices: (V, 3) the model it is coupled to, m.
        state: Pose, shape and place of the model; hands in its components.
        are_shown: Whether the scan has the left and the right hand; one that it has not is guessed.
        scan_to_mesh: (N,) m, of each point of the scan to the free surface.
        verdict: "good", "doubtful" or "bad".
        reasons: Why it is not good, and which hands are guessed.
        measures: What the verdict rests on.
        seconds: It took, by stage.
        scan: The scan's name.
        scan_digest: SHA-256 of its points.
        model_digest: SHA-256 of the model.
    """

    vertices: Array
    model_vertices: Array
    state: BodyState
    are_shown: tuple[bool, bool]
    scan_to_mesh: Array
    verdict: str
    reasons: tuple[str, ...]
    measures: dict[str, float] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    scan: str = ""
    scan_digest: str = ""
    model_digest: str = ""

    def summary(self) -> dict[str, Any]:
        """What `--json` lists."""
        return {
            "scan": self.scan,
            "seconds": round(sum(self.seconds.values()), 2),
            "verdict": self.verdict,
            "scan_to_mesh_mm": summarize_distances(self.scan_to_mesh),
            "hands_shown": {"left": self.are_shown[0], "right": self.are_shown[1]},
            "reasons": list(self.reasons),
        }


def save_body_registration(registration: BodyRegistration, faces: npt.NDArray, folder: Path) -> None:
    """Write `body.ply` and `body.npz`; each appears whole or not at all, the npz last."""
    folder.mkdir(parents=True, exist_ok=True)
    write_atomically(folder / PLY_FILE, write_ply(registration.vertices, faces))
    write_atomically(folder / BODY_FILE, pack_body_registration(registration))


def pack_body_registration(registration: BodyRegistration) -> bytes:
    """The bytes of `body.npz`."""
    state = registration.state
    said = {
        "verdict": registration.verdict,
        "reasons": list(registration.reasons),
        "measures": registration.measures,
        "seconds": registration.seconds,
        "scan": registration.scan,
        "scan_digest": registration.scan_digest,
        "model_digest": registration.model_digest,
    }
    return pack_npz(
        {
            "vertices": registration.vertices,
            "model_vertices": registration.model_vertices,
            "poses": state.pose.reshape(1, -1),
            "trans": state.translation[None],
            "betas": state.shape,
            "hands": state.hands,
            "are_shown": np.array(registration.are_shown),
            "scan_to_mesh": registration.scan_to_mesh.astype(np.float32),
            "said": np.array(json.dumps(said)),
        }
    )


@reads(RegistrationError, NEEDED)
def load_body_registration(folder: Path) -> BodyRegistration:
    """Read `body.npz` of a folder, or that file itself, checking every array.

    Raises:
        RegistrationError: With what was found and what is needed.
    """
    path = folder / BODY_FILE if folder.is_dir() else folder
    fields = NpzFields(path, read_foreign_npz(path, RegistrationError), RegistrationError)
    said = json.loads(fields.text("said", 100_000))
    vertices = fields.numbers("vertices", (-1, 3), MAX_COORDINATE)
    if len(vertices) > MAX_VERTICES:
        raise RegistrationError(path, f"{len(vertices)} vertices", f"at most {MAX_VERTICES}")
    state = BodyState(
        fields.numbers("poses", (1, 156), MAX_COORDINATE).reshape(52, 3),
        fields.numbers("betas", (-1,), MAX_COORDINATE),
        fields.numbers("trans", (1, 3), MAX_COORDINATE)[0],
        fields.numbers("hands", (2, -1), MAX_COORDINATE),
    )
    shown = fields.arrays["are_shown"].astype(bool)
    if shown.shape != (2,):
        raise RegistrationError(path, f"'are_shown' {shown.shape}", "two of them")
    return BodyRegistration(
        vertices,
        fields.numbers("model_vertices", vertices.shape, MAX_COORDINATE),
        state,
        (bool(shown[0]), bool(shown[1])),
        fields.numbers("scan_to_mesh", (-1,), MAX_COORDINATE),
        str(said["verdict"]),
        tuple(str(reason) for reason in said["reasons"]),
        {str(name): float(value) for name, value in said["measures"].items()},
        {str(name): float(value) for name, value in said["seconds"].items()},
        str(said["scan"]),
        str(said["scan_digest"]),
        str(said["model_digest"]),
    )
