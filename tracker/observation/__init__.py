"""The D of T16 Eq. 5: what the tracker keeps of a frame."""

from tracker.observation.observation import HAND, OTHER, Observation, Preprocessing, Region, observe, undistort

__all__ = ["HAND", "OTHER", "Observation", "Preprocessing", "Region", "observe", "undistort"]
