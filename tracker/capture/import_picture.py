"""One picture of what an import would store, by the name that its report gives."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import numpy.typing as npt

from tracker.capture.document import read_regular_file
from tracker.capture.image_file import MAX_IMAGE_BYTES, decode_color, decode_depth, read_header
from tracker.capture.listed_files import find_root
from tracker.capture.relative_path import find_path_fault, is_inside
from tracker.capture.video_file import VideoFile
from tracker.errors import FrameError

_VIDEO_FRAME = re.compile(r"(.+)#([0-9]{1,7})", re.DOTALL)


def read_import_picture(source: Path | str, name: str) -> npt.NDArray[np.uint8] | npt.NDArray[np.uint16]:
    """Pixels (H, W, 3) uint8 RGB of a colour image, or raw values (H, W) uint16 of a 16-bit grey one.

    Args:
        source: What was given to `check_import`.
        name: As in a report: relative to the folder that the recording begins in, `#n` for frame n of a video.
    """
    root = find_root(Path(source))
    match = _VIDEO_FRAME.fullmatch(name)
    file = match[1] if match and not (root / name).is_file() else name
    if fault := find_path_fault(file):
        raise FrameError(f"{file[:200]!r} {fault}.")
    path = root / file
    if not is_inside(path, root) or not path.is_file():
        raise FrameError(f"{file[:200]}: is not a file of this import.")
    if match and file != name:
        return VideoFile(root, file).read_frame(int(match[2]))
    try:
        data = read_regular_file(path, MAX_IMAGE_BYTES, FrameError)
        header = read_header(data, file)
        is_depth = header.kind == "png" and header.bits == 16 and header.channels == 1
        return decode_depth(data, file) if is_depth else decode_color(data, file)
    except FrameError as fault:
        raise FrameError(str(fault).replace(str(path), file)) from None
