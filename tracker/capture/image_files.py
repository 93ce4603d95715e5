"""A stream of image files, one for each frame."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.document import read_regular_file
from tracker.capture.image_file import (
    MAX_IMAGE_BYTES,
    ImageHeader,
    check_depth_header,
    check_whole,
    decode_color,
    decode_depth,
    read_header,
)
from tracker.capture.import_plan import DepthSample, SourceImage, StreamProbe
from tracker.capture.relative_path import is_inside
from tracker.errors import FrameError, TrackerError

_HEAD_BYTES = 256 * 1024
"""Of a file are read for its header: EXIF and colour profiles stand before the size of a JPEG."""
_PNG_END = b"\x00\x00\x00\x00IEND\xaeB`\x82"
_MOST_NAMED = 5
"""Files that a message names."""


@dataclass(frozen=True)
class ImageFiles:
    """Colour or depth images of a camera.

    Attributes:
        root: Folder the names belong to.
        names: Relative name of each frame's file, in order.
        is_depth: Whether they are depth images.
    """

    root: Path
    names: tuple[str, ...]
    is_depth: bool

    @property
    def suffix(self) -> str:
        suffix = Path(self.names[0]).suffix.lower() if self.names else ".png"
        return ".jpg" if suffix == ".jpeg" else suffix

    def name_of(self, index: int) -> str:
        return self.names[index]

    def probe(self, samples: int) -> StreamProbe:
        """Header and end of every file; pixels of some, the first and the last among them."""
        faults: list[str] = []
        missing: list[str] = []
        sizes: Counter[tuple[int, int]] = Counter()
        types: Counter[str] = Counter()
        by_size: dict[tuple[int, int], str] = {}
        sound: list[str] = []
        for name in self.names:
            if not (self.root / name).exists():
                missing.append(name)
                continue
            try:
                header = self._probe_file(name)
            except TrackerError as fault:
                faults.append(str(fault))
                continue
            size = (header.width, header.height)
            sizes[size] += 1
            by_size[size] = name
            types[f"{header.bits}-bit {'grey' if header.channels <= 2 else 'colour'} {header.kind.upper()}"] += 1
            sound.append(name)
        problems = _name_some(faults)
        if missing:
            problems.append(f"{len(missing)} of {len(self.names)} files are missing: {', '.join(_some(missing))}.")
        usual = sizes.most_common(1)[0][0] if sizes else None
        for size, count in sizes.items():
            if size != usual and usual is not None:
                problems.append(
                    f"{by_size[size]}: is {size[0]}x{size[1]} px where the others are {usual[0]}x{usual[1]} px "
                    f"({count} such {'file' if count == 1 else 'files'})."
                )
        depth = self._sample(sound, samples, problems)
        return StreamProbe(len(self.names), usual, dict(types), tuple(problems), depth=depth)

    def sample_depth(self, samples: int = 3) -> DepthSample:
        """Values of some depth images; of none when none can be read."""
        found = self._sample(list(self.names), samples, [])
        return found or DepthSample(0, 0, 0.0, 0.0, (), 0)

    def read(self) -> Iterator[SourceImage]:
        """Bytes of every file, unpacked and decoded once to be sure of them."""
        for name in self.names:
            data = self._read(name)
            image = (decode_depth if self.is_depth else decode_color)(data, name, inflate=True)
            yield SourceImage(name, data, (image.shape[1], image.shape[0]))

    def _read(self, name: str) -> bytes:
        path = self.root / name
        if not is_inside(path, self.root):
            raise FrameError(f"{name}: leads out of the recording.")
        try:
            return read_regular_file(path, MAX_IMAGE_BYTES, FrameError)
        except FrameError as fault:
            raise FrameError(str(fault).replace(str(path), name)) from None

    def _probe_file(self, name: str) -> ImageHeader:
        path = self.root / name
        if not is_inside(path, self.root) or not path.is_file():
            raise FrameError(f"{name}: is not a plain file inside the recording.")
        with path.open("rb") as file:
            head = file.read(_HEAD_BYTES)
            size = file.seek(0, 2)
            file.seek(max(0, size - len(_PNG_END)))
            tail = file.read()
        header = read_header(head, name)
        if self.is_depth:
            check_depth_header(header, name)
        if header.kind == "jpeg" or tail != _PNG_END:
            check_whole(self._read(name), name)
        return header

    def _sample(self, names: list[str], samples: int, problems: list[str]) -> DepthSample | None:
        chosen = [names[i] for i in np.unique(np.linspace(0, len(names) - 1, samples).astype(int))] if names else []
        tally = _DepthTally()
        faults: list[str] = []
        for name in chosen:
            try:
                data = self._read(name)
                if self.is_depth:
                    tally.add(decode_depth(data, name, inflate=True))
                else:
                    decode_color(data, name, inflate=True)
            except TrackerError as fault:
                faults.append(str(fault))
        problems += _name_some(faults)
        return tally.summarise() if tally.frames else None


class _DepthTally:
    """How often each raw value occurs in the depth images added so far."""

    def __init__(self) -> None:
        self.counts = np.zeros(65536, np.int64)
        self.frames = self.empty = 0

    def add(self, image: npt.NDArray[np.uint16]) -> None:
        self.counts += np.bincount(image.ravel(), minlength=65536)
        self.frames += 1
        self.empty += not image.any()

    def summarise(self) -> DepthSample:
        pixels, filled = int(self.counts.sum()), self.counts.copy()
        filled[0] = 0
        percentiles: tuple[float, ...] = ()
        if filled.any():
            ranks = np.cumsum(filled)
            percentiles = tuple(float(np.searchsorted(ranks, ranks[-1] * p / 100)) for p in (1, 5, 50, 95, 99))
        return DepthSample(
            frames=self.frames,
            empty_frames=self.empty,
            zero_share=float(self.counts[0]) / pixels,
            saturated_share=float(self.counts[65535]) / pixels,
            percentiles=percentiles,
            largest=int(np.flatnonzero(filled)[-1]) if percentiles else 0,
        )


def _some(names: list[str]) -> list[str]:
    return names if len(names) <= _MOST_NAMED else [*names[:_MOST_NAMED], f"and {len(names) - _MOST_NAMED} more"]


def _name_some(faults: list[str]) -> list[str]:
    """The first few faults, and how many more there are."""
    more = len(faults) - _MOST_NAMED
    return faults if more <= 0 else [*faults[:_MOST_NAMED], f"... and {more} more files like these."]
