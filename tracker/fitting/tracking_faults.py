"""What keeps a recording from being tracked, told by facts that are known without reading a frame."""

from __future__ import annotations

from collections.abc import Sequence

from tracker.fitting.options import TrackOptions


def find_tracking_faults(
    frame_count: int, hands: Sequence[str], depth_cameras: Sequence[str], options: TrackOptions
) -> list[str]:
    """Why a recording cannot be tracked so, in sentences for people; empty when it can be.

    Args:
        frame_count: Of the recording.
        hands: That it shows.
        depth_cameras: Ids of its cameras with depth images.
        options: What somebody chose.
    """
    faults = []
    if not depth_cameras:
        faults.append(
            "None of its cameras has depth images, and the tracker fits hands to depth. Import the recording with its "
            "depth images."
        )
    elif options.camera and options.camera not in depth_cameras:
        faults.append(f"Camera {options.camera} has no depth images. Choose {' or '.join(depth_cameras)}.")
    if not hands:
        faults.append("The recording does not say which hands it shows. Set its hands to right, left or both.")
    last = frame_count - 1 if options.last_frame < 0 else options.last_frame
    if options.first_frame > last or last >= frame_count:
        faults.append(
            f"Frames {options.first_frame} to {last} were asked for; the recording has 0 to {frame_count - 1}."
        )
    return faults


def find_detector_faults(looks_at: str, has_color: bool, options: TrackOptions) -> list[str]:
    """Why a run cannot use a fingertip detector that a lab has trained; empty when it can.

    Args:
        looks_at: `depth` or `color`.
        has_color: Whether the camera that is tracked in has colour images.
        options: What somebody chose.
    """
    faults = []
    if "S" not in options.term_letters:
        faults.append(
            f"The terms {options.terms} use no fingertips, so a fingertip detector would do nothing. Choose terms with "
            "S, such as LO+SC, or no detector of your own."
        )
    if looks_at == "color" and not has_color:
        faults.append(
            "The fingertip detector looks at colour, and the camera has no colour images. Choose one that looks at "
            "depth (`handloom train-detector --on depth`)."
        )
    return faults
