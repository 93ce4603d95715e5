"""Scans, registrations and what is decided about them, seen from a script."""

from __future__ import annotations

import json
import uuid
from collections.abc import Iterable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from server.client.link import Link


class Curation:
    """Of a studio, as the dictionaries that the API gives."""

    def __init__(self, link: Link) -> None:
        self._link = link

    def upload(self, paths: Iterable[Path | str], **options: Any) -> dict[str, Any]:
        """Send scans, or one zip of them; `options` are `collection`, `subject`, `pose`, `side`, `metres_per_unit`.

        Sent again, a scan that is there already is not kept twice, so who was cut off sends all once more.
        """
        with ExitStack() as stack:
            files = [(Path(path).name, stack.enter_context(Path(path).open("rb"))) for path in paths]
            parts = [("files", file) for file in files]
            return self._link.send("POST", "/scans", files=parts, data={"options": json.dumps(options)}).json()

    def scans(self, **filters: Any) -> Iterator[dict[str, Any]]:
        """Newest first; of a `collection`, `subject`, `pose`, `side` or `state`."""
        return self._link.pages("/scans", **filters)

    def registrations(self, **filters: Any) -> Iterator[dict[str, Any]]:
        """Those of a `queue` in an `order`, of a `model_id`, a `verdict`, and so on; see `docs/api.md`."""
        return self._link.pages("/registrations", **filters)

    def download_registration(self, registration_id: str, to: Path | str) -> Path:
        """`registration.npz`, as `handloom register` writes it."""
        return self._link.download(f"/registrations/{registration_id}/registration.npz", Path(to))

    def decide(
        self, registration_id: str, decision: str, reasons: Iterable[str] = (), note: str = ""
    ) -> dict[str, Any]:
        """`accept`, `reject` or `unsure`. An answer that is lost on the way does no harm: it is asked for again."""
        body = {"decision": decision, "reasons": list(reasons), "note": note, "operation_id": str(uuid.uuid4())}
        path = f"/registrations/{registration_id}/decisions"
        return self._link.send("POST", path, json=body, is_repeatable=True).json()

    def undo(self, decision_id: str) -> dict[str, Any]:
        """Take a decision of one's own back."""
        body = {"operation_id": str(uuid.uuid4())}
        return self._link.send("POST", f"/decisions/{decision_id}/undo", json=body, is_repeatable=True).json()

    def make_training_set(self, name: str, **rule: Any) -> dict[str, Any]:
        """Keep what a rule chooses now; the same registrations are kept once."""
        return self._link.send("POST", "/training-sets", json={"name": name, "rule": rule}, is_repeatable=True).json()

    def download_training_set(self, training_set_id: str, to: Path | str) -> Path:
        """A zip that `handloom train-model` takes when it is unpacked."""
        return self._link.download(f"/training-sets/{training_set_id}/registrations.zip", Path(to))

    def hand_models(self) -> Iterator[dict[str, Any]]:
        """Hand models, those that come with Handloom first."""
        return self._link.pages("/hand-models")

    def download_hand_model(self, model_id: str, to: Path | str) -> Path:
        """A model's file; as MANO's of the right or left hand when `to` ends in `.pkl` (`LEFT` in its name: left)."""
        to = Path(to)
        side = "left" if "LEFT" in to.name else "right"
        kind = f"mano/{side}" if to.suffix == ".pkl" else "model.npz"
        return self._link.download(f"/hand-models/{model_id}/{kind}", to)
