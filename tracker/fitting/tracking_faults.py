"""What keeps a recording from being tracked, as far as it is known without reading a frame."""

from __future__ import annotations

from collections.abc import Sequence

from tracker.errors import TrackingError
from tracker.fitting.options import TrackOptions
from tracker.physics import find_physics_fault

MAX_VIEWS = 16
"""Cameras of a run at most; more add time and hardly anything else."""


def find_tracking_faults(
    frame_count: int,
    hands: Sequence[str],
    depth_cameras: Sequence[str],
    color_cameras: Sequence[str],
    options: TrackOptions,
) -> list[str]:
    """Why a recording cannot be tracked with these options, in sentences for people; empty when it can be.

    Args:
        frame_count: Of the recording.
        hands: That it shows.
        depth_cameras: Ids of its cameras with depth images.
        color_cameras: Ids of its cameras with colour or infrared images.
        options: What somebody chose.
    """
    if options.view_ids or not depth_cameras:
        faults = _find_view_faults(depth_cameras if options.use_depth else (), color_cameras, options)
    elif options.camera and options.camera not in depth_cameras:
        faults = [f"Camera {options.camera} has no depth images. Choose {' or '.join(depth_cameras)}."]
    else:
        faults = []
    if "P" in options.term_letters and (fault := find_physics_fault()):
        faults.append(fault)
    if not hands:
        faults.append("The recording does not say which hands it shows. Set its hands to right, left or both.")
    try:
        options.frame_range(frame_count)
    except TrackingError as error:
        faults.append(str(error))
    return faults


def _find_view_faults(depth_cameras: Sequence[str], color_cameras: Sequence[str], options: TrackOptions) -> list[str]:
    """What keeps several cameras from being tracked in."""
    if not color_cameras:
        return ["None of its cameras has colour images, and hands are found in colour. Choose a single depth camera."]
    able = sorted({*color_cameras, *depth_cameras})
    unknown = [name for name in options.view_ids if name not in able]
    if unknown:
        return [
            f"{' and '.join(unknown)} {'are no cameras' if len(unknown) > 1 else 'is no camera'} with colour images of "
            f"this recording. Choose among {', '.join(able)}."
        ]
    views = options.view_ids or tuple(color_cameras)
    faults = []
    if not set(views) & set(color_cameras):
        have = "have" if len(views) > 1 else "has"
        faults.append(
            f"{' and '.join(views)} {have} no colour images, and hands are found in colour. Add one that has."
        )
    if len(set(views)) < len(views):
        faults.append(f"Cameras were chosen twice ({options.cameras}). Name each once.")
    if len(views) > MAX_VIEWS:
        faults.append(
            f"{len(views)} cameras are too many; at most {MAX_VIEWS} are tracked in. Choose those that see the "
            "hands best."
        )
    if not options.use_detector:
        faults.append("In colour images only the hand detector finds hands. Switch it on.")
    if options.is_as_written:
        faults.append("The method of T16 needs one depth camera. Choose Handloom's method.")
    return faults


def find_detector_faults(
    looks_at: str,
    depth_camera: str | None,
    color_cameras: Sequence[str],
    options: TrackOptions,
    finds: str = "fingertips",
) -> list[str]:
    """Why a run cannot use a detector that a lab has trained; empty when it can.

    Args:
        looks_at: `depth` or `color`.
        depth_camera: Id of the camera that is tracked in; None where colour cameras alone are.
        color_cameras: Ids of the cameras with colour images.
        options: What somebody chose.
        finds: `fingertips` or `nails`.
    """
    faults = []
    if depth_camera is None and finds != "nails":
        return [
            "A fingertip detector finds points in space with the help of depth, but only colour cameras are tracked "
            "in. Choose a detector of nails (`handloom train-detector --what nails`), or none of your own; the hand "
            "detector looks at every view."
        ]
    if depth_camera is not None and finds == "nails":
        return [
            "It finds finger nails in colour views, but a depth camera is tracked in. Choose "
            "colour cameras (`--cameras`), or a detector of fingertips."
        ]
    if "S" not in options.term_letters:
        faults.append(
            f"The terms {options.terms} use no fingertips, so a fingertip detector would do nothing. Choose terms with "
            "S, such as LO+SC, or no detector of your own."
        )
    if depth_camera is not None and looks_at == "color" and depth_camera not in color_cameras:
        faults.append(
            "The fingertip detector looks at colour, and the camera has no colour images. Choose one that looks at "
            "depth (`handloom train-detector --on depth`)."
        )
    return faults
