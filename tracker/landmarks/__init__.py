"""A hand's 21 joints in one image, colour or grey, by two small neural networks.

One network finds palms, the other the joints of a hand in a square around a palm, or around the joints of the frame
before. Both are those of MediaPipe Hands (Zhang et al., "MediaPipe Hands: On-device Real-time Hand Tracking", 2020;
Apache-2.0), converted by `scripts/build_hand_networks.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.landmarks.detected_hand import DetectedHand
    from tracker.landmarks.hand_detector import HandDetector, default_hand_detector

__getattr__, __dir__ = offer(__name__)
