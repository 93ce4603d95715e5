"""The one guard of readers: whatever is done to the bytes of a foreign file, its reader says what is wrong with it."""

from __future__ import annotations

import io
import json
import zipfile
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from tests.tracker.label_formats.test_hostile import make_hand
from tracker import Scan, load_annotations, untrained_hand
from tracker.calibration.board import Board
from tracker.calibration.board_file import load_board, write_board
from tracker.capture.anipose_calibration import parse_anipose
from tracker.capture.archive import extract_archive
from tracker.capture.colmap_calibration import parse_colmap
from tracker.capture.dat_calibration import parse_dat
from tracker.capture.image_file import decode_color, decode_depth
from tracker.capture.opencv_calibration import parse_opencv
from tracker.capture.scan import load_scan, save_scan
from tracker.capture.scan_ply import write_ply
from tracker.capture.video_file import VideoFile
from tracker.errors import AnnotationError, FileError, ScanError, TrackerError, reading, reads
from tracker.label_formats.formats import import_labels
from tracker.model.default_hand import default_hand
from tracker.model.files import load_model
from tracker.model.mano_files import load_mano
from tracker.model.mano_writer import save_mano
from tracker.model.npz_files import save_npz_model
from tracker.model.object_files import load_object
from tracker.tracking.arrays_file import load_arrays


@dataclass(frozen=True)
class Garble:
    """What happens to a file: cut off, and bytes put elsewhere; places are shares of its length."""

    keeps: float
    changes: tuple[tuple[float, int], ...]

    def apply(self, data: bytes) -> bytes:
        kept = bytearray(data[: max(1, round(self.keeps * len(data)))])
        for place, value in self.changes:
            kept[min(int(place * len(kept)), len(kept) - 1)] = value
        return bytes(kept)


SHARE = st.floats(0, 1, allow_nan=False)
GARBLES = st.builds(
    Garble,
    keeps=st.one_of(st.just(1.0), SHARE),
    changes=st.lists(st.tuples(st.one_of(SHARE, st.floats(0, 0.02)), st.integers(0, 255)), max_size=8).map(tuple),
)


def _npz(**arrays: np.ndarray) -> bytes:
    file = io.BytesIO()
    np.savez(file, **arrays)
    return file.getvalue()


POINTS = np.random.default_rng(1).normal(size=(60, 3)) * 0.03
TRIANGLES = np.arange(60).reshape(-1, 3)
OBJ = "".join(f"v {x} {y} {z}\n" for x, y, z in POINTS) + "".join(
    f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in TRIANGLES
)
OFF = f"OFF\n60 20 0\n{''.join(f'{x} {y} {z}' + chr(10) for x, y, z in 1e3 * POINTS)}" + "".join(
    f"3 {a} {b} {c}\n" for a, b, c in TRIANGLES
)
GLTF = json.dumps(
    {"asset": {"version": "2.0"}, "buffers": [{"uri": "data:;base64,AAAA", "byteLength": 3}], "nodes": [{}]}
)
CALIBRATION = (
    "[cam_0]\nname = 'A'\nsize = [4, 4]\nmatrix = [[1.0,0,1],[0,1,1],[0,0,1]]\n"
    "rotation = [0,0,0]\ntranslation = [0,0,0]\n"
)
ANNOTATIONS = json.dumps({"version": 1, "joints": [], "items": []})


def _image(kind: str, values: np.ndarray) -> bytes:
    return cv2.imencode(kind, values)[1].tobytes()


def _zip() -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a/b.txt", "text" * 30)
        archive.writestr("c.bin", bytes(range(200)))
    return file.getvalue()


def _read_zip(path: Path) -> object:
    return extract_archive(path, path.parent / f"unpacked-{path.stat().st_mtime_ns}")


@dataclass(frozen=True)
class Kind:
    """A kind of file: a sound one, and its reader."""

    name: str
    data: Callable[[Path], bytes]
    read: Callable[[Path], object]


def _mano(path: Path, suffix: str) -> bytes:
    file = path / f"MANO_RIGHT{suffix}"
    if not file.exists():
        save_mano(untrained_hand("right"), file)
    return file.read_bytes()


def _hand(path: Path) -> bytes:
    file = path / "sound.npz"
    if not file.exists():
        save_npz_model(default_hand("right"), file)
    return file.read_bytes()


def _scan(suffix: str) -> Callable[[Path], bytes]:
    def make(path: Path) -> bytes:
        file = path / f"sound{suffix}"
        save_scan(Scan(POINTS, np.zeros_like(POINTS), TRIANGLES, None, "x"), file)
        return file.read_bytes()

    return make


GOLDEN = Path(__file__).parent / "label_formats" / "golden"
"""One file of each format of labels."""


def _labels(name: str) -> Kind:
    def read(path: Path) -> object:
        return import_labels(None, {path.name: path.read_bytes()}, [make_hand()])

    return Kind(name, lambda _: (GOLDEN / name).read_bytes(), read)


def _video(path: Path) -> bytes:
    file = path / "sound.avi"
    writer = cv2.VideoWriter(str(file), cv2.VideoWriter.fourcc(*"MJPG"), 30.0, (32, 24))
    for shade in range(5):
        writer.write(np.full((24, 32, 3), 40 * shade, np.uint8))
    writer.release()
    return file.read_bytes()


DAT = "intrinsic:\n30 0 16\n0 30 12\n0 0 1\ndistortion:\n0 0 0 0 0\nR:\n1 0 0\n0 1 0\n0 0 1\nT:\n0\n0\n1\n"
COLOR = np.zeros((20, 20, 3), np.uint8)
GRAY = np.arange(400, dtype=np.uint16).reshape(20, 20) * 50
KINDS = (
    Kind("hand.npz", _hand, load_model),
    Kind("MANO_RIGHT.npz", lambda path: _mano(path, ".npz"), load_mano),
    Kind("MANO_RIGHT.pkl", lambda path: _mano(path, ".pkl"), load_mano),
    Kind("hand.gltf", lambda _: GLTF.encode(), load_model),
    Kind("thing.gltf", lambda _: GLTF.encode(), load_object),
    Kind("thing.obj", lambda _: OBJ.encode(), load_object),
    Kind("thing.off", lambda _: OFF.encode(), load_object),
    Kind("thing.ply", lambda _: write_ply(POINTS, TRIANGLES), load_object),
    Kind("scan.ply", lambda _: write_ply(POINTS, TRIANGLES), load_scan),
    Kind("scan.obj", lambda _: OBJ.encode(), load_scan),
    Kind("scan.npz", _scan(".npz"), load_scan),
    Kind("scan.stl", lambda _: b"solid x\n" + b"vertex 0 0 0\nvertex .1 0 0\nvertex 0 .1 0\n" * 9, load_scan),
    Kind(
        "color.png",
        lambda _: _image(".png", np.zeros((20, 20, 3), np.uint8)),
        lambda p: decode_color(p.read_bytes(), "x"),
    ),
    Kind(
        "color.jpg",
        lambda _: _image(".jpg", np.zeros((20, 20, 3), np.uint8)),
        lambda p: decode_color(p.read_bytes(), "x"),
    ),
    Kind("depth.png", lambda _: _image(".png", GRAY), lambda p: decode_depth(p.read_bytes(), "x", inflate=True)),
    Kind("recording.zip", lambda _: _zip(), _read_zip),
    Kind("calibration.toml", lambda _: CALIBRATION.encode(), lambda p: parse_anipose(p.read_bytes(), "x")),
    Kind(
        "cameras.txt",
        lambda _: b"1 OPENCV 640 480 500 500 320 240 0.1 0 0 0\n",
        lambda p: parse_colmap(p.read_bytes(), b"1 1 0 0 0 0 0 2 1 a/1.png\n", "x"),
    ),
    Kind(
        "images.txt",
        lambda _: b"1 1 0 0 0 0 0 2 1 a/1.png\n",
        lambda p: parse_colmap(b"1 PINHOLE 9 9 9 9 4 4\n", p.read_bytes(), "x"),
    ),
    Kind("board.toml", lambda _: write_board(Board("checkerboard", 9, 6, 0.025)), load_board),
    Kind("c0.dat", lambda _: DAT.encode(), lambda p: parse_dat(p.read_bytes(), None, "c0", "c0.dat")),
    Kind("video.avi", _video, lambda p: list(VideoFile(p.parent, p.name).read())),
    *(_labels(path.name) for path in sorted(GOLDEN.iterdir())),
    Kind("camera.npz", lambda _: _npz(K=np.eye(3)), lambda p: parse_opencv(p.read_bytes(), "x.npz")),
    Kind("annotations.json", lambda _: ANNOTATIONS.encode(), load_annotations),
    Kind(
        "track.npz",
        lambda _: _npz(frame=np.arange(9), pose=np.zeros((9, 4))),
        lambda p: load_arrays(p, ("frame", "pose")),
    ),
)


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("sound")


@pytest.mark.parametrize("kind", KINDS, ids=[kind.name for kind in KINDS])
def test_a_garbled_file_is_refused_by_its_readers_own_error(kind: Kind, sound: Path, tmp_path: Path) -> None:
    data = kind.data(sound)

    @settings(max_examples=40, deadline=None, suppress_health_check=list(HealthCheck))
    @given(garble=GARBLES)
    @example(Garble(1.0, ()))
    @example(Garble(0.5, ()))
    @example(Garble(1.0, tuple((0.001 * n, 0) for n in range(8))))
    def garble(garble: Garble) -> None:
        path = tmp_path / kind.name
        path.write_bytes(garble.apply(data))
        with suppress(TrackerError):  # anything else fails the test
            kind.read(path)

    garble()


def write_header(header: bytes) -> bytes:
    """An npz whose one array has this header."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        head = header.ljust(117) + b"\n"
        array = b"\x93NUMPY\x01\x00" + len(head).to_bytes(2, "little") + head + bytes(72)
        for name in ("vertices", "points", "v_template", "K", "frame", "format"):
            archive.writestr(f"{name}.npy", array)
    return file.getvalue()


@pytest.mark.parametrize(
    "header",
    [
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (3, 3), ",  # tokenize.TokenError: the seed found
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (3L, 3L), 'x': (",
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999, 99999999), }",
        b"{'descr': '<f8', 'fortran_order': False, 'shape': (-3, 3), }",
        b"{'descr': [('a', '<f8'), ('a', '<f8')], 'fortran_order': False, 'shape': (3,), }",
        b"'" * 90,
        b"(" * 100,
        b"\xff\xfe\x00",
    ],
)
@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind.name.endswith(".npz")], ids=lambda kind: kind.name)
def test_the_header_of_an_array_may_say_anything(kind: Kind, header: bytes, tmp_path: Path) -> None:
    path = tmp_path / kind.name
    path.write_bytes(write_header(header))
    with pytest.raises(TrackerError, match="needed"):
        kind.read(path)


FAULTS = [ValueError("x"), MemoryError(), RecursionError(), StopIteration(), AssertionError()]


@pytest.mark.parametrize("fault", FAULTS)
def test_whatever_a_parser_throws_becomes_the_readers_error(fault: Exception) -> None:
    kind = type(fault).__name__
    with pytest.raises(ScanError) as found, reading(ScanError, "a.ply", "a PLY"):
        raise fault
    assert str(found.value) == f"a.ply: found a damaged file ({kind}: {fault}); needed a PLY."
    assert isinstance(found.value, FileError) and found.value.__cause__ is fault
    with pytest.raises(AnnotationError) as other, reading(AnnotationError, "a.csv", "a table"):
        raise fault
    assert str(other.value) == f"a.csv: found a damaged file ({kind}: {fault}); needed a table."


def test_what_is_no_fault_of_the_file_comes_through() -> None:
    own = AnnotationError("in its own words")
    with pytest.raises(AnnotationError) as found, reading(ScanError, "a.ply", "a PLY"):
        raise own
    assert found.value is own
    with pytest.raises(KeyboardInterrupt), reading(ScanError, "a.ply", "a PLY"):
        raise KeyboardInterrupt


def test_a_guarded_reader_keeps_its_name_and_says_that_a_file_is_missing(tmp_path: Path) -> None:
    @reads(ScanError, "a PLY")
    def read_it(path: Path) -> bytes:
        return path.read_bytes()

    assert read_it.__name__ == "read_it"
    with pytest.raises(ScanError, match="No such file"):
        read_it(tmp_path / "none.ply")
