"""Cameras in a folder that somebody handed over."""

from __future__ import annotations

from pathlib import Path

from tracker.calibration.film_folder import list_films


def put(folder: Path, *names: str) -> None:
    for name in names:
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(b"x")


def test_videos_and_folders_are_cameras_and_lenses_and_noise_are_none(tmp_path: Path) -> None:
    put(tmp_path, "set/cam10.mp4", "set/cam2/in/0.png", "set/wide/GOPR1.MOV", "set/lenses/old.toml", "set/notes.txt")
    put(tmp_path, "set/.hidden/0.png", "__MACOSX/set/0.png")
    found = list_films(tmp_path)
    assert {name: path.relative_to(tmp_path).as_posix() for name, path in found.cameras.items()} == {
        "cam2": "set/cam2/in",
        "cam10": "set/cam10.mp4",
        "wide": "set/wide/GOPR1.MOV",
    }
    assert list(found.cameras) == ["cam2", "cam10", "wide"]
    assert found.lenses == tmp_path / "set" / "lenses"
    assert (found.faults, found.left_out) == ((), ("notes.txt",))


def test_what_may_be_meant_as_a_camera_and_is_none_is_named(tmp_path: Path) -> None:
    put(tmp_path, "a/1.mp4", "a/2.mp4", "b/readme.txt", "c.avi", "c/0.png")
    found = list_films(tmp_path)
    assert found.faults == (
        "a: holds 2 videos (1.mp4, 2.mp4); needed one for each camera.",
        "b: holds neither images (.png, .jpg, .jpeg) nor a video.",
        "c: two cameras have this name; rename one of them.",
    )
