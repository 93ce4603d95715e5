"""Hand models that learn from scans, as files: the untrained one, trained ones, uploaded ones."""

from __future__ import annotations

import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sqlalchemy.exc import IntegrityError
from sqlalchemy.orm import Session

from server.access.audit import record_act
from server.errors import ConflictError, InvalidError
from server.hand_models.models import HandModelRow
from server.hand_models.schemas import HandModelOut
from server.hand_models.service import AREA, FILE, NAMESPACE, get_hand_model, list_default_models
from server.storage import Storage
from server.storage.digest import compute_digest

if TYPE_CHECKING:
    from tracker import BlendModel

UNTRAINED_ID = uuid.uuid5(NAMESPACE, "untrained/right")
UNTRAINED_NAME = "Untrained right hand"
HAND_BONES = 16


class DamagedModelError(ConflictError):
    """The file is not what it was when the model was stored."""


def describe_untrained() -> HandModelOut:
    """The crude hand that scans are first registered with, before anybody has used it."""
    from tracker import untrained_hand

    return HandModelOut.model_validate(
        describe_model(untrained_hand("right"))
        | {"id": UNTRAINED_ID, "name": UNTRAINED_NAME, "kind": "untrained", "side": "right", "registers": True}
    )


def describe_learnt() -> list[HandModelOut]:
    """The learnt hands that come with Handloom, which recordings can be tracked with."""
    from tracker import BUILT_IN_HANDS

    described = []
    for hand in BUILT_IN_HANDS.values():
        named = {
            "id": uuid.uuid5(NAMESPACE, f"{hand.name}/right"),
            "name": hand.title,
            "kind": "default",
            "side": "right",
        }
        described.append(HandModelOut.model_validate(describe_model(hand.load("right")) | named))
    return described


def list_built_in(session: Session) -> list[HandModelOut]:
    """Those that come with Handloom and that no row stands for."""
    is_stored = session.get(HandModelRow, UNTRAINED_ID) is not None
    return [*list_default_models(), *describe_learnt(), *([] if is_stored else [describe_untrained()])]


def describe_model(model: BlendModel) -> dict[str, Any]:
    """What lists tell of a model, as fields of `HandModelOut`."""
    return {
        "vertices": len(model.template),
        "faces": len(model.faces),
        "bones": list(model.joint_names),
        "degrees_of_freedom": 3 + 3 * model.num_bones,
        "shape_parameters": [f"shape {number + 1}" for number in range(model.num_shape)],
        "pose_components": len(model.pose_components),
        "has_pose_shapes": bool(model.pose_directions.any()),
        "provenance": {str(name): str(value) for name, value in model.provenance.items()},
    }


def write_model(storage: Storage, model_id: uuid.UUID, model: BlendModel) -> str:
    """Write the file of a model, which is not there yet or was written by somebody who died; gives its SHA-256."""
    from tracker import save_blend_model

    folder = storage.folder(AREA, model_id)
    folder.mkdir(exist_ok=True)
    save_blend_model(model, folder / FILE)
    storage.publish(AREA, model_id)
    return compute_digest(folder / FILE)


def resolve_model(session: Session, storage: Storage, model_id: uuid.UUID | None) -> HandModelRow:
    """The stored model of an id; without one, or by its id, the untrained one, which is stored when first used."""
    if model_id not in (None, UNTRAINED_ID):
        return get_hand_model(session, model_id)
    if (row := session.get(HandModelRow, UNTRAINED_ID)) is not None:
        return row
    from tracker import untrained_hand

    model = untrained_hand("right")
    row = HandModelRow(
        id=UNTRAINED_ID,
        name=UNTRAINED_NAME,
        kind="untrained",
        side="right",
        digest=write_model(storage, UNTRAINED_ID, model),
        facts=describe_model(model),
        report=None,
    )
    try:
        with session.begin_nested():
            session.add(row)
            session.flush()
    except IntegrityError:  # somebody else used it first at this very moment
        return get_hand_model(session, UNTRAINED_ID)
    return row


def read_upload(path: Path, side: str | None) -> BlendModel:
    """A model in a file that somebody sent: Handloom's own npz, or MANO's npz or pickle, which is read and never run.

    Raises:
        InvalidError: It is no hand that scans can be registered with.
    """
    from tracker import TrackerError, load_blend_model, load_mano

    try:
        model = load_blend_model(path)
    except TrackerError as own:
        try:
            model = load_mano(path, side)
        except TrackerError as foreign:
            raise InvalidError(
                f"{path.name} is not a hand model. Read as Handloom's own: {_say(own, path)} Read as MANO's: "
                f"{_say(foreign, path)} A model whose side its name does not tell needs the field `side`."
            ) from None
    if model.side not in ("right", "left") or model.num_bones != HAND_BONES:
        raise InvalidError(
            f"{path.name} holds a {model.side} with {model.num_bones} joints; needed a hand with MANO's {HAND_BONES}."
        )
    return model


def _say(fault: Exception, path: Path) -> str:
    return str(fault).replace(f"{path.parent}/", "").replace(str(path.parent), "")


def add_uploaded(
    session: Session, storage: Storage, model: BlendModel, name: str, account_id: uuid.UUID
) -> HandModelRow:
    """Store a model that somebody sent."""
    model_id = uuid.uuid4()
    row = HandModelRow(
        id=model_id,
        name=name,
        kind="uploaded",
        side=model.side,
        digest=write_model(storage, model_id, model),
        facts=describe_model(model),
        report=None,
        created_by=account_id,
    )
    session.add(row)
    session.flush()
    record_act(session, account_id, "hand_model.upload", "hand_model", model_id, sha256=row.digest)
    return row


def find_file(storage: Storage, row: HandModelRow) -> Path:
    """The file of a stored model; raises when it is not what it was."""
    path = storage.folder(AREA, row.id) / FILE
    if not path.is_file() or compute_digest(path) != row.digest:
        raise DamagedModelError(
            f"The file of the hand model {row.name!r} is missing or was changed. Restore {AREA}/{row.id}/{FILE} "
            "from a backup."
        )
    return path


def open_model(storage: Storage, row: HandModelRow) -> BlendModel:
    """A stored model."""
    from tracker import load_blend_model

    return load_blend_model(find_file(storage, row))
