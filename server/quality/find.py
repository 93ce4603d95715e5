"""All checks of a recording's labels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from server.quality.bones import check_bone_lengths
from server.quality.evidence import check_reprojection, check_residuals
from server.quality.finding import Finding
from server.quality.labels import Label
from server.quality.neighbours import check_handedness, check_jumps
from server.quality.one_label import check_depth, check_finger_order, check_outside

if TYPE_CHECKING:
    from tracker import Camera


@dataclass(frozen=True)
class Setting:
    """What is known of the recording.

    Attributes:
        hands: Those that are said to be seen.
        cameras: By id.
        tracked: (21, 2) px of a track by camera, frame and hand.
    """

    hands: tuple[str, ...]
    cameras: dict[str, Camera]
    tracked: dict[tuple[str, int, str], npt.NDArray[np.float64]] = field(default_factory=dict)


def find_flags(labels: Sequence[Label], setting: Setting) -> list[Finding]:
    """What looks wrong, the worst first; of each kind at most one for a label."""
    sizes = {name: (camera.width, camera.height) for name, camera in setting.cameras.items()}
    worst: dict[tuple, Finding] = {}
    for finding in (
        *check_outside(labels, sizes),
        *check_finger_order(labels),
        *check_depth(labels),
        *check_bone_lengths(labels, setting.cameras),
        *check_handedness(labels, setting.hands),
        *check_jumps(labels),
        *check_reprojection(labels, setting.cameras),
        *check_residuals(labels, setting.tracked),
    ):
        key = finding.label.id, finding.kind
        if key not in worst or finding.score > worst[key].score:
            worst[key] = finding
    return sorted(worst.values(), key=lambda one: (-round(1e6 * one.score), str(one.label.id), one.kind))
