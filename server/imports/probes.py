"""What looking at an upload's files gave, so that looking again with other options takes no time.

An upload's files never change. A check that finds nothing here looks at the files itself.
"""

from __future__ import annotations

import threading
import uuid
from collections import OrderedDict
from collections.abc import Hashable

from tracker.capture import StreamProbe

MAX_UPLOADS = 8
_GUARD = threading.Lock()
_KEPT: OrderedDict[uuid.UUID, dict[Hashable, StreamProbe]] = OrderedDict()


def find_probes(import_id: uuid.UUID) -> dict[Hashable, StreamProbe]:
    """What is known of an upload; a check adds to it. The uploads that were asked for longest ago are forgotten."""
    with _GUARD:
        found = _KEPT.setdefault(import_id, {})
        _KEPT.move_to_end(import_id)
        while len(_KEPT) > MAX_UPLOADS:
            _KEPT.popitem(last=False)
        return found


def forget_probes(import_id: uuid.UUID) -> None:
    """Forget an upload."""
    with _GUARD:
        _KEPT.pop(import_id, None)
