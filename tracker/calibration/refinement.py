"""What labels make of a recording's cameras, before and after: a person looks at it and takes it or leaves it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from tracker.capture.camera import Camera
from tracker.errors import say_count


@dataclass(frozen=True)
class Agreement:
    """How far marks are from where cameras see the points that the marks of all of them make.

    Attributes:
        joints: How many marks.
        rms: px.
        median: px.
    """

    joints: int
    rms: float
    median: float

    def to_json(self) -> dict[str, Any]:
        numbers = {"rms": self.rms, "median": self.median}
        return {
            "joints": self.joints,
            **{name: round(value, 4) if np.isfinite(value) else None for name, value in numbers.items()},
        }


@dataclass(frozen=True)
class RefinedCamera:
    """One camera before and after.

    Attributes:
        id: As in the recording.
        is_moved: False of the one that stands still, and of those that share too few labels.
        moved_mm: How far its centre moved.
        turned_deg: How far it turned.
        focal_percent: How much longer its focal length became.
        unsure_px: One standard deviation of where it sees a point, anywhere in its picture at the labels' distance, by
            what the labels tell; 0 of the one that stands still.
        fitted_before: On the labels that were fitted to.
        fitted_after: Likewise.
        left_out_before: On the labels that were left out.
        left_out_after: Likewise.
    """

    id: str
    is_moved: bool
    moved_mm: float
    turned_deg: float
    focal_percent: float
    unsure_px: float
    fitted_before: Agreement
    fitted_after: Agreement
    left_out_before: Agreement
    left_out_after: Agreement

    def to_json(self) -> dict[str, Any]:
        return {
            "id": self.id,
            "is_moved": self.is_moved,
            "moved_mm": round(self.moved_mm, 3),
            "turned_deg": round(self.turned_deg, 4),
            "focal_percent": round(self.focal_percent, 4),
            "unsure_px": round(self.unsure_px, 3),
            "fitted_px": {"before": self.fitted_before.to_json(), "after": self.fitted_after.to_json()},
            "left_out_px": {"before": self.left_out_before.to_json(), "after": self.left_out_after.to_json()},
        }


@dataclass(frozen=True, eq=False)
class Refinement:
    """A recording's cameras as its labels have them.

    Attributes:
        cameras: All of the recording's, in its order.
        described: Of each.
        frames: Labelled frames that were fitted to.
        frames_left_out: Labelled frames that the cameras were judged by.
        kept: What gave place and scale, in a sentence.
        refusal: Why the cameras should stay as they are; empty when they got better.
    """

    cameras: tuple[Camera, ...]
    described: tuple[RefinedCamera, ...]
    frames: int
    frames_left_out: int
    kept: str
    refusal: str

    def to_json(self) -> dict[str, Any]:
        return {
            "frames": self.frames,
            "frames_left_out": self.frames_left_out,
            "kept": self.kept,
            "refusal": self.refusal,
            "cameras": [camera.to_json() for camera in self.described],
        }

    def say(self) -> str:
        """A table and sentences for people."""
        lines = [
            f"Fitted to {say_count(self.frames, 'labelled frame')}, judged by {self.frames_left_out} left out.",
            self.kept,
            f"{'camera':<12} {'moved':>9} {'turned':>8} {'unsure':>8} {'fitted, rms px':>18} {'left out, rms px':>18}",
        ]
        for one in self.described:
            if not one.is_moved and not one.fitted_before.joints:
                lines.append(f"{one.id:<12} stays as it is: too few of its labels are in another camera too")
                continue
            lines.append(
                f"{one.id:<12} {one.moved_mm:6.1f} mm {one.turned_deg:6.2f} ° {one.unsure_px:5.1f} px "
                f"{one.fitted_before.rms:8.2f} -> {one.fitted_after.rms:6.2f} "
                f"{one.left_out_before.rms:8.2f} -> {one.left_out_after.rms:6.2f}"
            )
        return "\n".join([*lines, self.refusal or "The cameras agree better with the labels that were left out."])
