"""Options of a registration."""

from __future__ import annotations

from dataclasses import dataclass, field

from tracker.registration.free_fit import FreeSettings
from tracker.registration.model_fit import FitSettings


@dataclass(frozen=True)
class RegistrationOptions:
    """How scans are registered; the defaults were measured, see docs/scans.md.

    Attributes:
        side: "right" or "left" when known; None tries both.
        use_colors: Drop points by R17's rule for green objects.
        max_points: Most points that are fitted; further ones are only measured.
        model_stages: Fits of pose and shape, each with the number of points it uses.
        free_stages: Fits of the free surface.
        last_stage: Fit of the model from where the surface left it. Edges tell nothing of where the model lies, and
            its shape was held back on the way.
    """

    side: str | None = None
    use_colors: bool = True
    max_points: int = 50_000
    model_stages: tuple[tuple[int, FitSettings], ...] = field(
        default=(
            (1500, FitSettings(10.0, 8, to_scan=0.3)),
            (5000, FitSettings(5.0, 8, to_scan=0.1)),
        )
    )
    free_stages: tuple[tuple[int, FreeSettings], ...] = field(
        default=(
            (5000, FreeSettings(1.0, 10.0, 3)),
            (5000, FreeSettings(0.2, 7.0, 3)),
            (20000, FreeSettings(0.02, 5.0, 4)),
        )
    )
    last_stage: tuple[int, FitSettings] = (5000, FitSettings(4.0, 8, pose_weight=0.3, shape_weight=1.0))
