"""A camera that stopped before the others: reported before a run begins, not in the middle of it."""

from __future__ import annotations

from collections.abc import Sequence as Many

from tracker.capture.sequence import Sequence
from tracker.errors import FrameError


def check_cameras_last(sequence: Sequence, cameras: Many[str], frames: range, with_depth: bool = True) -> None:
    """Refuse a run over frames of which a camera lacks the last image; of films `look` tells when they are opened.

    Args:
        sequence: The recording.
        cameras: Those of the run.
        frames: Of the run.
        with_depth: Whether depth images take part.

    Raises:
        FrameError: It says which camera, where it ends, and what to do.
    """
    for name in cameras:
        camera = sequence.camera(name)
        kinds = [("colour", "color", camera.color is not None), ("depth", "depth", camera.has_depth and with_depth)]
        for word, kind, is_there in kinds:
            if not is_there or sequence.image_path(kind, frames[-1], name).exists():
                continue
            held = (frame for frame in reversed(frames) if sequence.image_path(kind, frame, name).exists())
            last = next(held, None)
            if last is None:
                raise FrameError(
                    f"Camera {name}: none of its {word} images from frame {frames[0]} on is there. Copy them again, or "
                    "leave this camera out."
                )
            raise FrameError(
                f"Camera {name}: its {word} images end after frame {last}; the run goes to frame {frames[-1]}. The "
                f"camera stopped, or images are missing. End at frame {last} (`--frames {frames[0]}:{last + 1}`), copy "
                "them again, or leave this camera out."
            )
