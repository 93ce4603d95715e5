"""A video from outside as a stream of frames, numbered as they are decoded."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import numpy.typing as npt

from tracker.capture.calibration import MAX_PIXELS
from tracker.capture.import_plan import SourceImage, StreamProbe
from tracker.errors import FrameError, reading, say_count

VIDEO_SUFFIXES = (".mp4", ".m4v", ".mov", ".avi", ".mkv", ".webm")
MAX_FRAMES = 1_000_000
"""Of a recording: nine hours at 30 frames a second."""
JPEG_QUALITY = 95
"""Of the pictures of a video's frames, of 100."""


@dataclass(frozen=True)
class VideoFile:
    """Colour frames of a video.

    Attributes:
        root: Folder the name belongs to.
        name: Relative name.
        lossless: Store frames as PNG, not as JPEG of quality 95.
    """

    root: Path
    name: str
    lossless: bool = False

    @property
    def suffix(self) -> str:
        return ".png" if self.lossless else ".jpg"

    def name_of(self, index: int) -> str:
        return f"{self.name}#{index}"

    def probe(self, samples: int) -> StreamProbe:
        """Decode the whole video: the count in its header may be wrong. Pixels are looked at about `samples` times."""
        with self.open() as capture:
            fps = float(capture.get(cv2.CAP_PROP_FPS))
            promised = int(min(max(capture.get(cv2.CAP_PROP_FRAME_COUNT), 0), MAX_FRAMES))
            every = max(1, promised // max(1, samples))
            times: list[float] = []
            sizes: Counter[tuple[int, int]] = Counter()
            while capture.grab():
                if len(times) % every == 0:
                    image = self.retrieve(capture, len(times))
                    sizes[(image.shape[1], image.shape[0])] += 1
                times.append(float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000)
                if len(times) > MAX_FRAMES:
                    raise FrameError(f"{self.name}: has more than {MAX_FRAMES} frames.")
        problems = []
        if not times:
            problems.append(
                f"{self.name}: no frame can be decoded; is it cut off, or in a codec that is not known here?"
            )
        elif promised and len(times) < promised:
            problems.append(self._tell_missing(promised, times))
        if len(sizes) > 1:
            problems.append(f"{self.name}: the size of its frames changes ({', '.join(f'{w}x{h}' for w, h in sizes)}).")
        size = sizes.most_common(1)[0][0] if sizes else None
        return StreamProbe(
            len(times),
            size,
            {f"video frame, stored as {'PNG' if self.lossless else f'JPEG {JPEG_QUALITY}'}": len(times)},
            tuple(problems),
            timestamps=np.array(times),
            fps=fps if np.isfinite(fps) and 0.001 <= fps <= 100_000 else None,
        )

    def look(self) -> StreamProbe:
        """What its header, its first and its last frame tell, without decoding the rest; else as `probe`.

        A video whose header promises nothing, or does not hold as many frames as that, or whose last promised frame is
        not there, is decoded whole.
        """
        fps, promised = self.read_header()
        with self.open() as capture:
            size = None
            if promised and capture.grab():
                image = self.retrieve(capture, 0)
                size = image.shape[1], image.shape[0]
                is_whole = capture.set(cv2.CAP_PROP_POS_FRAMES, promised - 1) and capture.grab()
                size = size if promised == 1 or is_whole else None
        times = self._read_times()
        if size is None or len(times) != promised:
            return self.probe(2)
        types = {"video frame, decoded when asked for": promised}
        return StreamProbe(promised, size, types, timestamps=times, fps=fps or None)

    def _read_times(self) -> npt.NDArray[np.float64]:
        """(T,) s, of the frames that the file holds, without decoding any: it may promise some that were left out."""
        times: list[float] = []
        with self.open([cv2.CAP_PROP_FORMAT, -1]) as capture:
            while len(times) <= MAX_FRAMES and capture.grab():
                times.append(float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000)
        return np.sort(times)  # frames that refer to later ones are stored behind those

    def _tell_missing(self, promised: int, times: list[float]) -> str:
        """What a video with fewer frames than it promises is refused with; `times` (T,) s of those that it has."""
        told = f"{self.name}: promises {say_count(promised, 'frame')}, {len(times)} can be decoded"
        steps = np.diff(times)
        usual = float(np.median(steps)) if len(steps) else 0.0
        gaps = np.flatnonzero(steps > 1.5 * usual)
        left_out = int(np.sum(np.rint(steps[gaps] / usual) - 1)) if usual > 0 else 0
        if not left_out or left_out < promised - len(times):
            return f"{told}; copy it again, or leave this camera out."
        return (
            f"{told}: the camera left out {say_count(left_out, 'frame')}, the first after frame {gaps[0]} "
            f"({times[int(gaps[0])]:.2f} s), and all later ones would be taken for earlier moments. Have it converted "
            "to a constant frame rate, or leave this camera out."
        )

    def read(self) -> Iterator[SourceImage]:
        """Every frame in order, encoded to be stored."""
        flags = [] if self.lossless else [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
        with self.open() as capture:
            index = 0
            while capture.grab():
                image = self.retrieve(capture, index)
                done, data = cv2.imencode(self.suffix, image, flags)
                if not done:
                    raise FrameError(f"{self.name}, frame {index}: cannot be stored as {self.suffix}.")
                yield SourceImage(self.name_of(index), data.tobytes(), (image.shape[1], image.shape[0]))
                index += 1

    def images(self) -> Iterator[tuple[float, npt.NDArray[np.uint8]]]:
        """Every frame in order as it is decoded: its time in the video, s, and its pixels (H, W, 3) BGR."""
        with self.open() as capture:
            index = 0
            while capture.grab():
                time_s = float(capture.get(cv2.CAP_PROP_POS_MSEC)) / 1000
                yield time_s, self.retrieve(capture, index)
                index += 1

    def read_header(self) -> tuple[float, int]:
        """Frames a second and the number of frames that the header promises; 0 where it does not say."""
        with self.open() as capture:
            fps, count = (float(capture.get(what)) for what in (cv2.CAP_PROP_FPS, cv2.CAP_PROP_FRAME_COUNT))
        is_told = np.isfinite(fps) and 0.001 <= fps <= 100_000
        return fps if is_told else 0.0, int(min(max(count, 0), MAX_FRAMES))

    def read_frame(self, index: int) -> npt.NDArray[np.uint8]:
        """One frame (H, W, 3) RGB, near enough for people to look at: seeking is exact in most videos, not in all."""
        with self.open() as capture:
            capture.set(cv2.CAP_PROP_POS_FRAMES, index)
            if not capture.grab():
                raise FrameError(f"{self.name}, frame {index}: cannot be decoded.")
            return np.ascontiguousarray(self.retrieve(capture, index)[..., ::-1])

    def retrieve(self, capture: cv2.VideoCapture, index: int) -> np.ndarray:
        """(H, W, 3) uint8 BGR, the frame that was grabbed; `index` is for the message of a FrameError."""
        done, image = capture.retrieve()
        if not done or image is None or image.ndim != 3 or image.dtype != np.uint8:
            raise FrameError(f"{self.name}, frame {index}: cannot be decoded.")
        return image

    @contextmanager
    def open(self, settings: Sequence[int] = ()) -> Iterator[cv2.VideoCapture]:
        """The decoder, for a file that begins like a video: playlists and other texts would make it open more files.

        Args:
            settings: OpenCV's properties and their values in turn.
        """
        path = (self.root / self.name).resolve()
        if not path.is_file():
            raise FrameError(f"{self.name}: there is no such file.")
        with path.open("rb") as file:
            head = file.read(16)
        is_video = (
            head[4:8] in (b"ftyp", b"moov", b"mdat", b"wide", b"free", b"skip")
            or head.startswith(b"\x1a\x45\xdf\xa3")
            or (head.startswith(b"RIFF") and head[8:12] == b"AVI ")
        )
        if not is_video:
            raise FrameError(f"{self.name}: is no MP4, MOV, AVI, MKV or WebM video (begins with {head[:8].hex(' ')}).")
        capture = cv2.VideoCapture(str(path), cv2.CAP_FFMPEG, list(settings))
        try:
            with reading(FrameError, self.name, "a video that can be decoded"):
                if not capture.isOpened():
                    raise FrameError(
                        f"{self.name}: cannot be opened; is it cut off, or in a codec that is not known here?"
                    )
                if capture.get(cv2.CAP_PROP_FRAME_WIDTH) * capture.get(cv2.CAP_PROP_FRAME_HEIGHT) > MAX_PIXELS:
                    raise FrameError(f"{self.name}: has more than {MAX_PIXELS} pixels a frame.")
                yield capture
        finally:
            capture.release()
