"""The two chains from a scan to a model, as rows without files."""

from __future__ import annotations

import uuid
from dataclasses import dataclass
from typing import Any

from server.access.models import LOCAL_ACCOUNT_ID
from server.database import Base, Database
from server.hand_models.models import HandModelRow
from server.lineage.schemas import Kind
from server.moving_scans.models import (
    BodySetRow,
    FrameRegistrationRow,
    MovingRegistrationRow,
    MovingScanRow,
    PersonModelRow,
    StretchDecisionRow,
)
from server.registrations.decision_models import DecisionRow
from server.registrations.models import RegistrationRow
from server.registrations.training_set_models import TrainingMemberRow, TrainingSetRow
from server.scans.models import ScanRow
from tests.server.rows import keep

DIGEST = "0" * 64


def make_scan(name: str, subject: str = "Ada", pose: str = "flat") -> ScanRow:
    facts: dict[str, Any] = {"byte_count": 1, "point_count": 9, "face_count": 0, "has_colors": False, "notes": []}
    facts |= {"extent_m": [0.1, 0.1, 0.1], "file": "scan.ply", "digest": DIGEST, "collection": "hands"}
    return ScanRow(id=uuid.uuid4(), name=name, subject=subject, pose=pose, **facts)


def make_model(name: str, round_: int, **columns: Any) -> HandModelRow:
    facts = {"kind": "trained", "side": "right", "digest": DIGEST, "facts": {}, "round": round_}
    return HandModelRow(id=uuid.uuid4(), name=name, **facts, **columns)


def make_registration(scan: ScanRow, model: HandModelRow, **columns: Any) -> RegistrationRow:
    facts = {"round": 1, "crop_revision": 1, "digest": DIGEST, "side": "right", "verdict": "good", "score": 0.1}
    more = {"reasons": [], "scan_to_mesh_mm": {}, "seconds": 1.0, "scan_id": scan.id, "model_id": model.id}
    return RegistrationRow(id=uuid.uuid4(), **(facts | more | columns))


def make_decision(about: RegistrationRow, number: int = 1, account_id: uuid.UUID = LOCAL_ACCOUNT_ID) -> DecisionRow:
    facts: dict[str, Any] = {"decision": "accept", "reasons": [], "note": "", "is_blind": False, "number": number}
    ids = {"registration_id": about.id, "model_id": about.model_id, "account_id": account_id}
    return DecisionRow(id=uuid.uuid4(), operation_id=uuid.uuid4(), **facts, **ids)


def make_moving_registration(scan: MovingScanRow, template: uuid.UUID | None = None, **more: Any) -> Any:
    """Of frames 0 to 2; its own model's where none is given."""
    id_ = uuid.uuid4()
    facts = {"job_id": uuid.uuid4(), "prior": "mixture", "holds_hands": True, "has_velocity": True}
    facts |= {"population": "neutral", "first_frame": 0, "last_frame": 2, "template_id": template or id_}
    return MovingRegistrationRow(id=id_, moving_scan_id=scan.id, **(facts | more))


@dataclass
class Chains:
    """Every thing by a name of its own, such as `scan` or `second_model`."""

    things: dict[str, tuple[Kind, Base]]

    def id(self, name: str) -> uuid.UUID:
        return self.things[name][1].id

    def name(self, kind: Kind, id_: uuid.UUID) -> str:
        return next(name for name, (its, row) in self.things.items() if (its, row.id) == (kind, id_))


def store_chains(database: Database) -> Chains:
    """Two scans registered by a first model, one of them accepted and trained from; the second model registers it
    anew. A moving scan, registered, accepted, made a set and the person's model, which registers it once more."""
    first = make_model("first", 0)
    scan, other = make_scan("scan"), make_scan("other", subject="", pose="")
    registration, rest = make_registration(scan, first), make_registration(other, first)
    decision = make_decision(registration)
    chosen = TrainingSetRow(id=uuid.uuid4(), name="chosen", rule={}, digest=DIGEST, registration_count=1)
    chosen.subject_count, chosen.mirrored_count = 1, 0
    member = TrainingMemberRow(training_set_id=chosen.id, registration_id=registration.id, decision_id=decision.id)
    second = make_model("second", 1, parent_id=first.id, training_set_id=chosen.id)
    anew = make_registration(scan, second, verdict="doubtful")
    keep(database, first, scan, other, registration, rest, decision, chosen, member, second, anew)

    moving = MovingScanRow(
        id=uuid.uuid4(), name="Ada waves", subject="Ada", fps=30.0, frames=[], frame_count=3, usable_count=3,
        digest=DIGEST, byte_count=1, metres_per_unit=1.0, is_unit_guessed=False, box_m=[], notes=[],
    )  # fmt: skip
    laid = make_moving_registration(moving)
    finer = make_moving_registration(moving, laid.id, parent_id=laid.id, prior="none", first_frame=1)
    frame = FrameRegistrationRow(
        id=uuid.uuid4(), registration_id=laid.id, frame=0, digest=DIGEST, verdict="good", reasons=[],
        scan_to_mesh_mm={}, has_left=True, has_right=True, seconds=1.0,
    )  # fmt: skip
    stretch, refused = (
        StretchDecisionRow(
            id=uuid.uuid4(), moving_scan_id=moving.id, registration_id=laid.id, number=number, decision=word, note="",
            account_id=LOCAL_ACCOUNT_ID, first_frame=0, last_frame=number, operation_id=uuid.uuid4(),
        )
        for number, word in ((1, "accept"), (2, "reject"))
    )  # fmt: skip
    members = [{"frame": 0, "frame_registration_id": str(frame.id), "digest": DIGEST, "decision_id": str(stretch.id)}]
    bodies = BodySetRow(
        id=uuid.uuid4(), moving_scan_id=moving.id, name="bodies", digest=DIGEST, frame_count=1, members=members
    )
    person = PersonModelRow(
        id=uuid.uuid4(), body_set_id=bodies.id, name="person", population="female", digest=DIGEST, frame_count=1
    )
    begun = make_moving_registration(moving, person.id)
    keep(database, moving, laid, finer, frame, stretch, refused, bodies, person, begun)
    return Chains(
        {
            "scan": ("scan", scan),
            "other": ("scan", other),
            "registration": ("registration", registration),
            "rest": ("registration", rest),
            "anew": ("registration", anew),
            "decision": ("decision", decision),
            "chosen": ("training_set", chosen),
            "first": ("hand_model", first),
            "second": ("hand_model", second),
            "moving": ("moving_scan", moving),
            "laid": ("moving_registration", laid),
            "finer": ("moving_registration", finer),
            "begun": ("moving_registration", begun),
            "stretch": ("stretch_decision", stretch),
            "refused": ("stretch_decision", refused),
            "bodies": ("body_set", bodies),
            "person": ("person_model", person),
        }
    )
