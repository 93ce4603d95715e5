"""Which model stands for which hand or object."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from tracker.errors import TrackerError
from tracker.model.built_in_hands import BUILT_IN_HANDS
from tracker.model.max_faces import MAX_FACES

if TYPE_CHECKING:
    from tracker.model.articulated import ArticulatedModel


def load_hands(
    given: Sequence[tuple[str, Path | None]], hands: tuple[str, ...], max_faces: int | None = MAX_FACES
) -> dict[str, ArticulatedModel]:
    """A model for each of the hands: from the file given for it, a built-in hand, or the default hand.

    Heavier meshes are decimated to `max_faces`; None keeps them.

    Raises:
        TrackerError: A file is given for a hand that is not among them, or holds none of that side.
    """
    from tracker.model.default_hand import default_hand

    files = dict(given)
    for name in BUILT_IN_HANDS.keys() & files.keys():
        del files[name]
        files = dict.fromkeys(hands, Path(name)) | files
    for side in files:
        if side not in hands:
            raise TrackerError(f"--hand {side}: there are the hands {list(hands)} only.")
    models = {}
    for side in hands:
        path = files.get(side)
        models[side] = default_hand(side) if path is None else _load_hand(path, side, max_faces)
        found = models[side].hand
        if found is None or found.side != side:
            raise TrackerError(
                f"{path}: is {'not a hand' if found is None else f'a {found.side} hand'}; needed a {side} hand."
            )
    return models


def _load_hand(path: Path, side: str, max_faces: int | None) -> ArticulatedModel:
    from tracker.model import load_model
    from tracker.model.blend_articulated import articulated_of

    built_in = BUILT_IN_HANDS.get(str(path))
    return load_model(path, max_faces) if built_in is None else articulated_of(built_in.load(side))


def load_objects(
    given: Sequence[tuple[str, Path]], objects: tuple[str, ...], max_faces: int | None = MAX_FACES
) -> dict[str, ArticulatedModel]:
    """A model for each object that a file is given for, decimated as `load_hands` says.

    Raises:
        TrackerError: The recording names no such object.
    """
    from tracker.model import load_model

    models = {}
    for name, path in given:
        if name not in objects:
            raise TrackerError(f"--object {name}: the recording names {list(objects) or 'no objects'}.")
        models[name] = load_model(path, max_faces)
    return models
