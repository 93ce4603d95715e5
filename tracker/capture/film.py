"""A video as the colour images of a camera, decoded when they are asked for."""

from __future__ import annotations

import zlib
from array import array
from contextlib import ExitStack
from threading import RLock

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.video_file import VideoFile
from tracker.errors import FrameError, reading, say_count

FAR = 24
"""Frames that are decoded to get forward rather than jumped over: about as many as lie between two key frames."""

SAMPLED_ROWS = 16
"""One row of a frame in this many is summed up, to recognise the frame later."""

UNKNOWN = -1
"""Checksum of a frame that was not decoded yet."""


class Film:
    """Frames of a video by their number, whatever the order they are asked for in.

    A frame's number is how many frames are decoded before it, as in an import. Going on decodes on. Going back jumps to
    the frame and believes the jump only if the pixels are those that were decoded there before; else, and where that
    frame was not decoded before, the video is decoded anew from its beginning. At most two frames are held.

    Any thread may ask; one is served at a time. The decoder is given back by `close`, or with the film itself; a film
    that is asked again opens again.

    Args:
        video: The file.
        frame_count: As many frames as it is taken to have.
    """

    def __init__(self, video: VideoFile, frame_count: int) -> None:
        self.video = video
        self.frame_count = frame_count
        self._lock = RLock()
        self._sums = array("q", [UNKNOWN]) * frame_count
        self._open_files = ExitStack()
        self._decoder: cv2.VideoCapture | None = None
        self._next = 0
        self._held: tuple[int, npt.NDArray[np.uint8]] | None = None

    def frame(self, index: int) -> npt.NDArray[np.uint8]:
        """(H, W, 3) uint8 RGB; not to be written to, as others may be given the same.

        Raises:
            FrameError: There is no such frame, or the video ends or breaks before it.
        """
        if not 0 <= index < self.frame_count:
            raise FrameError(
                f"{self.video.name}: there is no frame {index}; frames go from 0 to {self.frame_count - 1}."
            )
        with self._lock, reading(FrameError, self.video.name, "a video that can be decoded"):
            if self._held is None or self._held[0] != index:
                self._held = index, self._jump(index) if self._is_far(index) else self._decode(index)
            return self._held[1]

    def close(self) -> None:
        """Give the decoder back."""
        with self._lock:
            self._held = None
            self._decoder = None
            self._open_files.close()

    def _is_far(self, index: int) -> bool:
        """Whether to jump: it can be told whether that led there, and decoding on does not lead there soon."""
        if self._decoder is None or self._sums[index] == UNKNOWN:
            return False
        return not self._next <= index < self._next + FAR

    def _jump(self, index: int) -> npt.NDArray[np.uint8]:
        decoder = self._decoder
        assert decoder is not None
        if decoder.set(cv2.CAP_PROP_POS_FRAMES, index) and decoder.grab():
            image = self.video.retrieve(decoder, index)
            if _sum_up(image) == self._sums[index]:
                self._next = index + 1
                return _to_rgb(image)
        self.close()
        return self._decode(index)

    def _decode(self, index: int) -> npt.NDArray[np.uint8]:
        """A frame by decoding on, from the beginning where it is past already."""
        if self._decoder is None or index < self._next:
            self.close()
            self._decoder, self._next = self._open_files.enter_context(self.video.open()), 0
        while self._next <= index:
            if not self._decoder.grab():
                there = self._next
                self.close()
                raise FrameError(
                    f"{self.video.name}: ends after {say_count(there, 'frame')} that can be decoded, where "
                    f"{self.frame_count} should be: the camera stopped, or the file is broken. Copy it again, or leave "
                    "this camera out."
                )
            self._next += 1
        image = self.video.retrieve(self._decoder, index)
        self._sums[index] = _sum_up(image)
        return _to_rgb(image)


def _sum_up(image: npt.NDArray[np.uint8]) -> int:
    return zlib.crc32(np.ascontiguousarray(image[::SAMPLED_ROWS]).data)


def _to_rgb(image: np.ndarray) -> npt.NDArray[np.uint8]:
    return np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2RGB), dtype=np.uint8)
