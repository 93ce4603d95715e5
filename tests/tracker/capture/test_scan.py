"""Scans from files of every kind, whole, damaged and hostile."""

from __future__ import annotations

import struct
import time

import numpy as np
import pytest

from tracker.capture.scan import MAX_POINTS, Scan, find_vertex_normals, load_scan, save_scan
from tracker.errors import ScanError
from tracker.model.untrained_hand import untrained_hand


@pytest.fixture(scope="module")
def scan() -> Scan:
    hand = untrained_hand()
    colors = np.random.default_rng(0).integers(0, 255, hand.template.shape, dtype=np.uint8)
    normals = find_vertex_normals(hand.template, hand.faces)
    return Scan(hand.template, normals, np.asarray(hand.faces, dtype=np.int64), colors, "hand")


def surface_set(scan: Scan) -> set[tuple[int, ...]]:
    """Triangles by their corners' places in 0.01 mm, so that the order of points does not matter."""
    corners = np.rint(scan.points.astype(np.float32)[scan.faces] * np.float32(1e5)).astype(int)
    return {tuple(np.roll(c, -min(range(3), key=lambda k: tuple(c[k])), axis=0).ravel()) for c in corners}


def write_ascii_ply(scan: Scan, path, polygons: bool = False) -> None:
    lines = ["ply", "format ascii 1.0", "comment x", f"element vertex {len(scan.points)}"]
    lines += [f"property double {a}" for a in "xyz"] + [f"property uchar {c}" for c in ("red", "green", "blue")]
    lines += [f"element face {len(scan.faces)}", "property list uchar int vertex_index", "end_header"]
    lines += [" ".join(map(repr, [*p.tolist(), *c.tolist()])) for p, c in zip(scan.points, scan.colors, strict=True)]
    lines += [f"3 {a} {b} {c}" for a, b, c in scan.faces]
    path.write_text("\n".join(lines) + "\n")


def write_big_endian_ply(scan: Scan, path) -> None:
    header = f"ply\nformat binary_big_endian 1.0\nelement vertex {len(scan.points)}\n"
    header += "".join(f"property float {a}\n" for a in "xyz")
    header += (
        f"element face {len(scan.faces)}\nproperty uchar flags\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    body = scan.points.astype(">f4").tobytes()
    body += b"".join(struct.pack(">BBIII", 7, 3, *face) for face in scan.faces)
    path.write_bytes(header.encode() + body)


def write_obj(scan: Scan, path) -> None:
    lines = ["mtllib nowhere.mtl", "vt 0 0"]
    lines += [f"vn 1 0 0\nv {x!r} {y!r} {z!r}" for x, y, z in scan.points.tolist()]
    lines += [f"f {a + 1}/1/{a + 1} {b + 1}//{b + 1} {c - len(scan.points)}" for a, b, c in scan.faces]
    path.write_text("\n".join(lines))


def write_stl(scan: Scan, path) -> None:
    corners = scan.points[scan.faces].astype("<f4")
    body = b"".join(struct.pack("<3f", 0, 0, 1) + c.tobytes() + b"\0\0" for c in corners)
    path.write_bytes(b"solid by name only".ljust(80) + struct.pack("<I", len(corners)) + body)


WRITERS = {
    "little.ply": lambda scan, path: save_scan(scan, path),
    "ascii.ply": write_ascii_ply,
    "big.ply": write_big_endian_ply,
    "mesh.obj": write_obj,
    "mesh.stl": write_stl,
    "scan.npz": lambda scan, path: save_scan(scan, path),
}


@pytest.mark.parametrize("name", WRITERS)
def test_every_format_brings_back_the_same_surface_with_normals_outwards(scan, tmp_path, name):
    WRITERS[name](scan, tmp_path / name)
    back = load_scan(tmp_path / name)
    assert len(back.points) == len(scan.points)
    assert surface_set(back) == surface_set(scan)
    middle = back.points.mean(axis=0)
    assert np.einsum("nd,nd->", back.points - middle, back.normals) > 0.0
    assert np.linalg.norm(back.normals, axis=1) == pytest.approx(np.ones(len(back.normals)), abs=1e-6)


@pytest.mark.parametrize("name", ["little.ply", "ascii.ply", "scan.npz"])
def test_colours_stay_with_their_points(scan, tmp_path, name):
    WRITERS[name](scan, tmp_path / name)
    back = load_scan(tmp_path / name)
    order, own = np.lexsort(np.rint(back.points * 1e6).T), np.lexsort(np.rint(scan.points * 1e6).T)
    assert np.array_equal(back.colors[order], scan.colors[own])


def test_npz_keeps_every_bit(scan, tmp_path):
    save_scan(scan, tmp_path / "scan.npz")
    back = load_scan(tmp_path / "scan.npz", 1.0)
    assert {tuple(p) for p in back.points} == {tuple(p) for p in scan.points}


@pytest.mark.parametrize(("scale", "unit"), [(1e3, "mm"), (1.0, "m")])
def test_metres_and_millimetres_are_told_by_the_size(scan, tmp_path, scale, unit):
    big = Scan(scan.points * scale, scan.normals, scan.faces)
    save_scan(big, tmp_path / "scan.ply")
    assert np.ptp(load_scan(tmp_path / "scan.ply").points[:, 0]) == pytest.approx(np.ptp(scan.points[:, 0]), rel=1e-5)


@pytest.mark.parametrize("metres_per_unit", [0.01, 0.0254, 0.0285, 0.1])
def test_a_unit_that_the_size_leaves_open_is_asked_for_and_not_guessed(scan, tmp_path, metres_per_unit):
    save_scan(Scan(scan.points / metres_per_unit, scan.normals, scan.faces), tmp_path / "scan.ply")
    with pytest.raises(ScanError, match=r"a size of .* units.*its unit \(metres per unit\)"):
        load_scan(tmp_path / "scan.ply")
    assert np.ptp(load_scan(tmp_path / "scan.ply", metres_per_unit).points[:, 0]) == pytest.approx(
        np.ptp(scan.points[:, 0]), rel=1e-5
    )


def test_a_given_unit_is_taken_unless_no_hand_has_that_size(scan, tmp_path):
    save_scan(Scan(scan.points / 0.0285, scan.normals, scan.faces), tmp_path / "scan.ply")
    assert np.ptp(load_scan(tmp_path / "scan.ply", 0.0285).points[:, 0]) == pytest.approx(
        np.ptp(scan.points[:, 0]), rel=1e-5
    )
    for unit, told in ((5.0, r"33.* m long"), (0.01, r"6.* cm long")):
        with pytest.raises(ScanError, match=rf"a scan that is {told} with 1 unit = .* mm.*correct its unit"):
            load_scan(tmp_path / "scan.ply", unit)
    for unit in (0.0, -1.0, float("nan")):
        with pytest.raises(ScanError, match="positive"):
            load_scan(tmp_path / "scan.ply", unit)


def test_points_that_are_not_finite_go_and_the_others_stay(scan, tmp_path):
    points = scan.points.copy()
    points[::10] = np.nan
    points[5] = np.inf
    save_scan(Scan(points, scan.normals, scan.faces), tmp_path / "scan.ply")
    back = load_scan(tmp_path / "scan.ply")
    assert np.isfinite(back.points).all() and np.isfinite(back.normals).all()
    assert len(back.points) == np.isfinite(points).all(axis=1).sum()
    assert back.faces.max() < len(back.points)


def test_split_vertices_are_merged(scan, tmp_path):
    corners = scan.points[scan.faces].reshape(-1, 3)
    save_scan(Scan(corners, corners * 0, np.arange(len(corners)).reshape(-1, 3)), tmp_path / "scan.ply")
    assert len(load_scan(tmp_path / "scan.ply").points) == len(scan.points)


def test_an_inside_out_mesh_is_turned(scan, tmp_path):
    save_scan(Scan(scan.points, -scan.normals, scan.faces[:, ::-1]), tmp_path / "scan.ply")
    assert surface_set(load_scan(tmp_path / "scan.ply")) == surface_set(scan)


def test_a_cloud_without_normals_has_zeros(scan, tmp_path):
    save_scan(Scan(scan.points, scan.normals * 0), tmp_path / "scan.ply")
    back = load_scan(tmp_path / "scan.ply")
    assert back.faces is None and not back.normals.any()


def test_five_million_points_are_thinned_in_seconds(tmp_path):
    points = np.random.default_rng(0).uniform(0, 0.2, (5_000_000, 3))
    save_scan(Scan(points, np.zeros_like(points)), tmp_path / "large.ply")
    began = time.process_time()
    scan = load_scan(tmp_path / "large.ply")
    assert len(scan.points) == MAX_POINTS
    assert np.abs(scan.points.mean(axis=0) - 0.1).max() < 1e-3
    assert time.process_time() - began < 10.0


HOSTILE = {
    "empty.ply": b"",
    "empty.obj": b"",
    "empty.stl": b"",
    "empty.npz": b"",
    "text.ply": b"this is no scan",
    "header.ply": b"ply\nformat ascii 1.0\nelement vertex 3\n",
    "promise.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 999999999999\nproperty float x\nend_header\n",
    "short.ply": b"ply\nformat binary_little_endian 1.0\nelement vertex 1000\n"
    b"property float x\nproperty float y\nproperty float z\nend_header\n1234",
    "twice.ply": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float x\nend_header\n1 1\n",
    "nothing_of_it.ply": b"ply\nformat ascii 1.0\nelement vertex 3\nend_header\n",
    "flat.ply": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nend_header\n1 1\n",
    "word.ply": b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
    b"end_header\n1 1 one\n",
    "list.ply": b"ply\nformat ascii 1.0\nelement face 1\n"
    b"property list uchar int vertex_index\nend_header\n4000000000 1\n",
    "word.obj": b"v 1 2 x\n",
    "far.obj": b"v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nf 1 2 9\n",
    "uneven.obj": b"v 0 0 0\nv 0.1 0\n",
    "promise.stl": b"\0" * 80 + b"\xff\xff\xff\xff" + b"\0" * 50,
    "word.stl": b"solid a\nvertex 1 2 x\n",
    "scan.fbx": b"x",
    "pickle.npz": b"PK\x03\x04 not a zip",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_bad_file_is_refused_with_what_was_found_and_what_is_needed(tmp_path, name):
    (tmp_path / name).write_bytes(HOSTILE[name])
    with pytest.raises(ScanError, match=r"found .*; needed ") as refused:
        load_scan(tmp_path / name)
    assert name in str(refused.value)


def test_a_missing_file_a_face_out_of_range_and_objects_in_an_npz_are_refused(scan, tmp_path):
    with pytest.raises(ScanError, match="cannot be read"):
        load_scan(tmp_path / "nothing.ply")
    np.savez(tmp_path / "faces.npz", points=scan.points, faces=scan.faces + 5000)
    with pytest.raises(ScanError, match="triangle with the point"):
        load_scan(tmp_path / "faces.npz")
    np.savez(tmp_path / "objects.npz", points=np.array([object()] * 60, dtype=object))
    with pytest.raises(ScanError, match="needed an npz"):
        load_scan(tmp_path / "objects.npz")
    np.savez(tmp_path / "nan.npz", points=np.full((1000, 3), np.nan))
    with pytest.raises(ScanError, match="0 finite points of 1000"):
        load_scan(tmp_path / "nan.npz")
    np.savez(tmp_path / "one.npz", points=np.zeros((1000, 3)))
    with pytest.raises(ScanError, match="1 different points"):
        load_scan(tmp_path / "one.npz")
