"""What cameras filmed, in a folder: a video or images for each, perhaps known lenses."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tracker.capture.image_file import COLOR_SUFFIXES
from tracker.capture.numbered_files import sort_naturally
from tracker.capture.video_file import VIDEO_SUFFIXES
from tracker.errors import say_count


@dataclass(frozen=True)
class FilmFolder:
    """What was found.

    Attributes:
        cameras: Videos and folders of images by the cameras' names, in the order that people expect.
        lenses: Folder with known lenses; None when there is none.
        faults: Sentences about entries that may be meant as cameras and are none.
        left_out: Names of files that are neither.
    """

    cameras: dict[str, Path]
    lenses: Path | None
    faults: tuple[str, ...]
    left_out: tuple[str, ...]


def list_films(folder: Path) -> FilmFolder:
    """The cameras in a folder; one that holds nothing but another folder stands for that one."""
    entries = _list(folder)
    while len(entries) == 1 and entries[0].is_dir() and not _has_images(entries[0]):
        entries = _list(entries[0])
    cameras: dict[str, Path] = {}
    lenses = None
    faults, left_out = [], []
    for entry in entries:
        if entry.is_dir() and entry.name.casefold() == "lenses":
            lenses = entry
            continue
        if not entry.is_dir() and not entry.name.lower().endswith(VIDEO_SUFFIXES):
            left_out.append(entry.name)
            continue
        name = entry.name if entry.is_dir() else entry.stem
        pictures = _find_pictures(entry)
        if not pictures:
            faults.append(f"{name}: holds neither images ({', '.join(COLOR_SUFFIXES)}) nor a video.")
        elif len(pictures) > 1:
            shown = ", ".join(path.name for path in pictures[:3])
            faults.append(f"{name}: holds {say_count(len(pictures), 'video')} ({shown}); needed one for each camera.")
        elif name in cameras:
            faults.append(f"{name}: two cameras have this name; rename one of them.")
        else:
            cameras[name] = pictures[0]
    return FilmFolder(cameras, lenses, tuple(faults), tuple(left_out))


def _find_pictures(entry: Path) -> list[Path]:
    """The video or the folder of images that an entry stands for; none, or several videos, when it is not clear."""
    if not entry.is_dir():
        return [entry]
    inside = _list(entry)
    if _has_images(entry):
        return [entry]
    if videos := [path for path in inside if path.is_file() and path.name.lower().endswith(VIDEO_SUFFIXES)]:
        return videos
    folders = [path for path in inside if path.is_dir()]
    return _find_pictures(folders[0]) if len(folders) == 1 else []


def _has_images(folder: Path) -> bool:
    return any(path.is_file() and path.name.lower().endswith(COLOR_SUFFIXES) for path in _list(folder))


def _list(folder: Path) -> list[Path]:
    names = (entry.name for entry in folder.iterdir() if not entry.name.startswith((".", "__MACOSX")))
    return [folder / name for name in sort_naturally(names)]
