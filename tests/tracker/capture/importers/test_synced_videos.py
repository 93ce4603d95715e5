"""Synchronised videos: frames by decoding, calibration in any of the known files."""

from __future__ import annotations

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from tracker.calibration import anipose_file
from tracker.calibration.colmap_file import write_colmap
from tracker.capture import ImportOptions, check_import, load_sequence, run_import
from tracker.capture.camera import Camera

SIZE = (96, 64)
K0 = np.array([[90.0, 0, 47.5], [0, 91.0, 31.5], [0, 0, 1]])
K1 = np.array([[92.0, 0, 46.5], [0, 93.0, 32.5], [0, 0, 1]])
LENS = np.array([0.01, -0.02, 0.001, 0.002, 0.0])
TURN = np.array([0.1, -0.4, 0.05])
MOVE = np.array([-300.0, 10.0, 40.0])  # mm
MILLIMETRES = ImportOptions(world_unit_m=0.001, hands=("right",))


def write_video(path: Path, frames: int = 12, fps: float = 30.0, size: tuple[int, int] = SIZE) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), fps, size)
    assert writer.isOpened()
    for i in range(frames):
        writer.write(np.full((size[1], size[0], 3), 20 * i, np.uint8))
    writer.release()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    for n in (0, 1):
        write_video(tmp_path / f"session/cam{n}.avi")
    return tmp_path / "session"


def write_anipose(folder: Path, **changes: object) -> None:
    lines = []
    for n, (K, r, t) in enumerate([(K0, np.zeros(3), np.zeros(3)), (K1, TURN, MOVE)]):
        table: dict[str, object] = {
            "name": f"cam{n}",
            "size": list(SIZE),
            "matrix": K.tolist(),
            "distortions": LENS.tolist(),
            "rotation": r.tolist(),
            "translation": t.tolist(),
        }
        table |= changes
        lines += [f"[cam_{n}]", *(f"{k} = {json.dumps(v)}" for k, v in table.items())]
    (folder / "calibration.toml").write_text("\n".join([*lines, "[metadata]", "error = 0.5"]))


def write_yaml(path: Path, **values: object) -> None:
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for name, value in values.items():
        storage.write(name, value)  # pyright: ignore
    storage.release()


def write_stereo_yaml(folder: Path) -> None:
    R = cv2.Rodrigues(TURN)[0]
    write_yaml(folder / "intrinsics.yml", M1=K0, D1=LENS, M2=K1, D2=LENS)
    write_yaml(folder / "extrinsics.yml", R=R, T=MOVE, R1=np.eye(3), R2=np.eye(3), P1=np.eye(3, 4), Q=np.eye(4))


def write_own_yaml(folder: Path) -> None:
    for n, (K, r, t) in enumerate([(K0, np.zeros(3), np.zeros(3)), (K1, TURN, MOVE)]):
        values = {"image_width": SIZE[0], "image_height": SIZE[1], "camera_matrix": K}
        write_yaml(folder / f"cam{n}.yaml", **values, distortion_coefficients=LENS, rvec=r, tvec=t)


def write_json(folder: Path) -> None:
    cameras = [
        {"id": "cam0", "K": K0.tolist(), "distortion": LENS.tolist()},
        {
            "id": "cam1",
            "K": K1.tolist(),
            "dist": [LENS.tolist()],
            "R": cv2.Rodrigues(TURN)[0].tolist(),
            "t": MOVE.tolist(),
        },
    ]
    (folder / "cameras.json").write_text(json.dumps({"cameras": cameras}))


def write_opencv_json(folder: Path) -> None:
    R = cv2.Rodrigues(TURN)[0]
    write_yaml(
        folder / "stereo.json", cameraMatrix1=K0, distCoeffs1=LENS, cameraMatrix2=K1, distCoeffs2=LENS, R=R, T=MOVE
    )


def write_npz(folder: Path) -> None:
    np.savez(
        folder / "stereo.npz",
        mtx1=K0,
        dist1=LENS[None],
        mtx2=K1,
        dist2=LENS[None],
        R=cv2.Rodrigues(TURN)[0],
        T=MOVE[:, None],
    )


def write_dat(folder: Path) -> None:
    def rows(matrix: np.ndarray) -> str:
        return "\n".join(" ".join(repr(float(v)) for v in row) + " " for row in matrix)

    for n, (K, r, t) in enumerate([(K0, np.zeros(3), np.zeros(3)), (K1, TURN, MOVE)]):
        (folder / f"c{n}.dat").write_text(f"intrinsic:\n{rows(K)}\ndistortion:\n{rows(LENS[None])}\n")
        more = "\n#below is something else\nR:\n1 2 3\n" if n else ""
        (folder / f"rot_trans_c{n}.dat").write_text(f"R:\n{rows(cv2.Rodrigues(r)[0])}\nT:\n{rows(t[:, None])}\n{more}")


WRITERS = [write_anipose, write_stereo_yaml, write_own_yaml, write_json, write_opencv_json, write_npz, write_dat]


@pytest.mark.parametrize("write", WRITERS, ids=lambda w: w.__name__)
def test_every_kind_of_calibration_gives_the_same_cameras(folder: Path, tmp_path: Path, write) -> None:
    write(folder)
    report = run_import(folder, tmp_path / "store/r", options=MILLIMETRES)
    assert [w for w in report.warnings if "have different names" not in w] == []
    cameras = load_sequence(tmp_path / "store/r").cameras
    assert [camera.id for camera in cameras] == ["cam0", "cam1"]
    np.testing.assert_allclose(cameras[0].K, K0)
    np.testing.assert_allclose(cameras[1].K, K1)
    np.testing.assert_allclose(cameras[1].distortion, LENS)
    np.testing.assert_allclose(cameras[0].T_world_camera, np.eye(4), atol=1e-12)
    points = np.random.default_rng(0).uniform(-0.1, 0.1, (20, 3)) + np.array([0, 0, 0.8])
    expected = cv2.projectPoints(points, TURN, MOVE / 1000, K1, LENS)[0][:, 0]
    np.testing.assert_allclose(cameras[1].project(points), expected, atol=1e-6)
    assert next(iter(report.baselines_m.values())) == pytest.approx(np.linalg.norm(MOVE) / 1000)


def test_a_calibration_of_our_own_says_its_unit_and_colmaps_text_is_asked_for_one(folder: Path, tmp_path: Path) -> None:
    T = np.eye(4)
    T[:3, 3] = [0.3, 0.0, 0.0]
    cameras = [Camera("cam0", *SIZE, K0, LENS), Camera("cam1", *SIZE, K1, LENS, T)]
    (folder / "cameras.toml").write_bytes(anipose_file.write_anipose(cameras))
    told = ImportOptions(hands=("right",))
    report = check_import(folder, options=told)
    assert report.problems == () and "world_unit_m" not in report.takes, "what the file says is not asked for"
    other = check_import(folder, options=ImportOptions(hands=("right",), world_unit_m=0.04))
    assert other.baselines_m == report.baselines_m
    assert "The calibration says its unit itself, 1 m; the 0.04 m given were not used." in other.warnings
    run_import(folder, tmp_path / "out", options=told)
    assert np.allclose(load_sequence(tmp_path / "out").cameras[1].T_world_camera, T)
    (folder / "cameras.toml").unlink()
    for name, data in write_colmap(cameras).items():
        (folder / name).write_bytes(data)
    asked = check_import(folder, options=told)
    assert any("unit of the calibration" in problem for problem in asked.problems) and "world_unit_m" in asked.takes
    run_import(folder, tmp_path / "colmap", options=ImportOptions(hands=("right",), world_unit_m=1.0))
    found = load_sequence(tmp_path / "colmap").cameras
    assert np.allclose(found[1].T_world_camera, T) and np.allclose(found[1].K, K1)


def test_frames_are_numbered_as_they_are_decoded(folder: Path, tmp_path: Path) -> None:
    write_anipose(folder)
    run_import(folder, tmp_path / "store/r", options=ImportOptions(world_unit_m=0.001, color_format="png"))
    sequence = load_sequence(tmp_path / "store/r")
    assert sequence.frame_count == 12 and sequence.fps == 30
    for index in range(12):
        color = sequence.frame(index, "cam1").color
        assert color is not None and abs(int(color.mean()) - 20 * index) <= 3
    stored = json.loads((tmp_path / "store/r/sources.json").read_text())["cameras"]["cam1"]["color"]
    assert stored[5]["source"] == "cam1.avi#5" and stored[5]["file"] == "cam1/color/000005.png"


def test_different_frame_counts_are_refused_until_the_rest_may_be_cut(folder: Path, tmp_path: Path) -> None:
    write_anipose(folder)
    write_video(folder / "cam1.avi", frames=10)
    report = check_import(folder, options=MILLIMETRES)
    assert not report.ok and "cam0 color 12, cam1 color 10" in report.problems[0]
    allowed = ImportOptions(world_unit_m=0.001, allow_gaps=True)
    report = run_import(folder, tmp_path / "store/r", options=allowed)
    assert report.frame_count == 10 and "Only the first 10" in " ".join(report.warnings)
    assert report.left_out == ("cam0.avi#10", "cam0.avi#11")
    assert len(list((tmp_path / "store/r/cam0/color").iterdir())) == 10


def test_different_frame_rates_are_refused_until_the_rate_is_told(folder: Path) -> None:
    write_anipose(folder)
    write_video(folder / "cam1.avi", fps=25)
    report = check_import(folder, options=MILLIMETRES)
    assert not report.ok and "Frame rates differ: cam0 color 30, cam1 color 25" in " ".join(report.problems)
    assert check_import(folder, options=ImportOptions(world_unit_m=0.001, fps=30)).ok


def test_videos_of_another_size_than_calibrated_are_refused(folder: Path) -> None:
    write_anipose(folder, size=[192, 128])
    report = check_import(folder, options=MILLIMETRES)
    assert not report.ok and "cam0: is calibrated for 192x128 px; its images are 96x64 px" in report.problems[0]


@pytest.mark.parametrize(
    "changes",
    [
        {"matrix": [[1, 2], [3, 4]]},
        {"matrix": "none"},
        {"matrix": [[90, 0, "x"], [0, 90, 1], [0, 0, 1]]},
        {"matrix": [[0, 0, 0], [0, 0, 0], [0, 0, 1]]},
        {"distortions": [0.1, 0.2, 0.3]},
        {"rotation": [[2, 0, 0], [0, 2, 0], [0, 0, 2]]},
        {"rotation": [1, 2]},
        {"translation": [1, 2]},
        {"translation": [1e12, 0, 0]},
        {"size": [0, 0]},
        {"size": [[]]},
        {"fisheye": True},
    ],
    ids=str,
)
def test_an_impossible_calibration_is_refused(folder: Path, changes: dict[str, object]) -> None:
    write_anipose(folder, **changes)
    report = check_import(folder, options=MILLIMETRES)
    assert not report.ok
    json.dumps(report.to_json(), allow_nan=False)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("calibration.toml", b"\xff\xfe"),
        ("calibration.toml", b"[cam_0\n"),
        ("calibration.toml", b"a = " + b"[" * 100_000),
        ("calibration.toml", b"[metadata]\n"),
        ("stereo.yml", b"K1: [1, 2\n"),
        ("stereo.yml", b"K1: !!python/object/apply:os.system ['true']\n"),
        ("stereo.yml", b"K1: !!opencv-matrix\n   rows: 1000000\n   cols: 1000000\n   dt: d\n   data: [1]\nK2: [1]\n"),
        ("stereo.json", b"{"),
        ("stereo.json", b"3"),
        ("stereo.json", b'{"cameras": [{"K": NaN}]}'),
        ("stereo.json", b'{"cameras": [3]}'),
        ("stereo.npz", b"PK"),
        ("stereo.npz", b"\x80\x04."),
        ("c0.dat", b"\xff\xff\xff"),
        ("c0.dat", b"intrinsic:\n1 2 3\n4 5\n"),
        ("c0.dat", b"intrinsic:\n1 nan 3\n"),
    ],
)
def test_a_damaged_calibration_is_refused(folder: Path, name: str, data: bytes) -> None:
    (folder / name).write_bytes(data)
    report = check_import(folder, options=MILLIMETRES)
    assert not report.ok
    json.dumps(report.to_json(), allow_nan=False)


def test_a_pickle_in_a_calibration_is_not_opened(folder: Path) -> None:
    np.savez(folder / "stereo.npz", mtx1=np.array([{"a": 1}], dtype=object), mtx2=K1)
    report = check_import(folder, options=MILLIMETRES)
    assert not report.ok and "stereo.npz" in report.problems[0]


def test_an_npz_that_unpacks_to_much_is_refused(folder: Path) -> None:
    np.savez_compressed(folder / "stereo.npz", mtx1=np.zeros(10_000_000))
    assert "unpacks to more" in check_import(folder, options=MILLIMETRES).problems[0]


def test_videos_without_a_calibration_are_refused(folder: Path) -> None:
    assert "no calibration" in check_import(folder).problems[0]


def test_the_report_of_a_calibration_may_lie_beside_it_but_no_second_calibration(folder: Path, tmp_path: Path) -> None:
    write_anipose(folder)
    (folder / "calibration_report").mkdir()
    (folder / "calibration_report" / "board.toml").write_text('kind = "charuco"\ncolumns = 4\n')
    run_import(folder, tmp_path / "new", options=MILLIMETRES)
    assert [camera.id for camera in load_sequence(tmp_path / "new").cameras] == ["cam0", "cam1"]
    (folder / "other.toml").write_bytes((folder / "calibration.toml").read_bytes())
    assert "leave one in the folder" in check_import(folder, options=MILLIMETRES).problems[0]


def test_more_videos_than_cameras_are_refused(folder: Path) -> None:
    write_anipose(folder)
    write_video(folder / "cam2.avi")
    assert "3 videos" in check_import(folder, options=MILLIMETRES).problems[0]


@pytest.mark.parametrize("size", [0, 5, 40, 3000])
def test_a_truncated_video_is_refused(folder: Path, size: int) -> None:
    write_anipose(folder)
    path = folder / "cam1.avi"
    path.write_bytes(path.read_bytes()[:size])
    assert not check_import(folder, options=MILLIMETRES).ok


@pytest.mark.parametrize(
    "text", ["#EXTM3U\n#EXTINF:1,\n/etc/passwd\n", "ffconcat version 1.0\nfile '/etc/passwd'\n", "<MPD></MPD>"]
)
def test_a_playlist_with_the_name_of_a_video_is_not_opened(folder: Path, text: str) -> None:
    write_anipose(folder)
    (folder / "cam1.avi").write_text(text)
    report = check_import(folder, options=MILLIMETRES)
    assert "cam1.avi: is no MP4, MOV, AVI, MKV or WebM video" in " ".join(report.problems)


def test_names_decide_which_camera_took_which_video(tmp_path: Path) -> None:
    folder = tmp_path / "session"
    for name in ("trial1-right.avi", "trial1-left.avi"):
        write_video(folder / name)
    write_anipose(folder)
    text = (folder / "calibration.toml").read_text()
    (folder / "calibration.toml").write_text(text.replace('"cam0"', '"right"').replace('"cam1"', '"left"'))
    run_import(folder, tmp_path / "store/r", options=MILLIMETRES)
    cameras = {camera.id: camera for camera in load_sequence(tmp_path / "store/r").cameras}
    np.testing.assert_allclose(cameras["trial1-right"].K, K0)
    np.testing.assert_allclose(cameras["trial1-left"].K, K1)


def test_a_single_video_comes_in_with_told_intrinsics(folder: Path, tmp_path: Path) -> None:
    options = ImportOptions(fx=90, cx=47.5, cy=31.5)
    report = run_import(folder / "cam0.avi", tmp_path / "store/r", options=options)
    assert report.frame_count == 12 and load_sequence(tmp_path / "store/r").cameras[0].id == "cam0"
