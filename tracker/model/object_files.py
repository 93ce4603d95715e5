"""Meshes that users bring, as rigid objects: OBJ, PLY, STL, OFF and static glTF."""

from __future__ import annotations

import io
import logging
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import trimesh

from tracker.errors import ModelFileError, reads
from tracker.model.articulated import ArticulatedModel
from tracker.model.decimation import decimate_file
from tracker.model.file_limits import MAX_BYTES, MAX_VERTICES
from tracker.model.gltf_container import Gltf, read_gltf
from tracker.model.gltf_files import MAX_NODES, node_to_world
from tracker.model.object_mesh import clean_mesh
from tracker.model.skeleton import Skeleton
from tracker.model.t16_text import read_off

log = logging.getLogger(__name__)

Array = npt.NDArray[np.float64]
Faces = npt.NDArray[np.int64]

OBJECT_SUFFIXES: tuple[str, ...] = (".obj", ".ply", ".stl", ".off", ".glb", ".gltf")

NEEDED = "triangles of one object (a hand comes as .npz, skinned .glb or .gltf, or a T16 .OFF with its other files)"

MAX_FILE_FACES = 1_000_000
"""Of a mesh; a bound of ours."""
MAX_OBJECT_FACES = 1500
"""To which a larger mesh is reduced, unless asked otherwise."""

UNITS: tuple[tuple[str, float], ...] = (("metres", 1.0), ("millimetres", 1e-3), ("centimetres", 1e-2))
"""Tried in this order when the unit is not given: 10 to 1500 units across are read as mm, as most files are."""

SIZES = (0.010, 1.5)
"""m; diagonal of the box around an object that hands handle: the first unit that gives one within is taken."""

POSSIBLE_SIZES = (1e-3, 10.0)
"""m; sizes that are believed when the unit is given."""


@dataclass(frozen=True)
class ObjectSize:
    """How large a mesh is, and in which units it has a size that a hand can hold.

    Attributes:
        sides: (3,) of the box around it, in the file's unit.
        guess: m; the unit that is assumed when none is given, or None.
        units: Usual units that make a possible size of it: what each is called, and m.
    """

    sides: tuple[float, float, float]
    guess: float | None
    units: tuple[tuple[str, float], ...]

    def find_fault(self, metres_per_unit: float) -> str:
        """Why it cannot be in this unit, or nothing."""
        size = float(np.linalg.norm(self.sides)) * metres_per_unit
        if POSSIBLE_SIZES[0] <= size <= POSSIBLE_SIZES[1]:
            return ""
        return f"it would be {size:.3g} m across; needed {1e3 * POSSIBLE_SIZES[0]:g} mm to {POSSIBLE_SIZES[1]:g} m"


@reads(ModelFileError, NEEDED)
def measure_object(path: Path) -> ObjectSize:
    """The size of a mesh before it is used."""
    vertices = _read_checked(path)[0]
    sides = np.ptp(vertices, axis=0)
    size = float(np.linalg.norm(sides))
    fit = [(name, scale) for name, scale in UNITS if POSSIBLE_SIZES[0] <= size * scale <= POSSIBLE_SIZES[1]]
    return ObjectSize((float(sides[0]), float(sides[1]), float(sides[2])), _guess_unit(size), tuple(fit))


def _guess_unit(size: float) -> float | None:
    return next((scale for _, scale in UNITS if SIZES[0] <= size * scale <= SIZES[1]), None)


@reads(ModelFileError, NEEDED)
def load_object(
    path: Path, max_faces: int | None = MAX_OBJECT_FACES, metres_per_unit: float | None = None
) -> ArticulatedModel:
    """A rigid object from a mesh file, in the file's own coordinates scaled to metres.

    One bone, whose joint is the middle of the surface: the six root parameters are all there is. So `T_world_model` of
    a posed scene, and `T_world_object` of a recording, take the file's coordinates, in m, to the world.

    What was assumed stands in the provenance and in the log: the unit, and that a mesh has holes.

    Args:
        path: The file.
        max_faces: Decimate a heavier mesh to so many; None keeps it.
        metres_per_unit: Length of the file's unit, such as 0.001; guessed from the size of the mesh when left out.

    Raises:
        ModelFileError: With what was found and what is needed.
    """
    path = Path(path)
    vertices, faces = _read_checked(path)
    mesh = clean_mesh(vertices, faces)
    if len(mesh.faces) < 2:
        raise ModelFileError(path, "no triangles with an area", NEEDED)
    scale, unit = _find_unit(path, mesh.vertices, metres_per_unit)
    provenance = {"file": path.name, "format": path.suffix[1:].upper(), "unit": unit, "holes": "none"}
    if mesh.open_edges:
        provenance["holes"] = f"{mesh.open_edges} edges without just two faces; what is inside is guessed near them"
        log.warning("%s: the mesh has holes: %s.", path, provenance["holes"])
    model = ArticulatedModel(
        name=path.stem,
        vertices=mesh.vertices * scale,
        faces=mesh.faces,
        skinning_weights=np.ones((len(mesh.vertices), 1)),
        skeleton=Skeleton.of_one_bone(path.stem, find_middle(mesh.vertices, mesh.faces) * scale),
        provenance=provenance,
    )
    return model if max_faces is None else decimate_file(path, model, max_faces)


def _read_checked(path: Path) -> tuple[Array, Faces]:
    """Vertices that triangles use, and the triangles."""
    vertices, faces = _read(path)
    if not len(faces):
        raise ModelFileError(path, "no triangles", NEEDED)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise ModelFileError(path, f"vertices of shape {vertices.shape}", "three coordinates for each vertex")
    if len(vertices) > MAX_VERTICES or len(faces) > MAX_FILE_FACES:
        raise ModelFileError(
            path, f"{len(vertices)} vertices and {len(faces)} faces", f"at most {MAX_VERTICES} and {MAX_FILE_FACES}"
        )
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ModelFileError(path, f"a face with the vertex {faces.max()}", f"vertices below {len(vertices)}")
    if not np.all(np.isfinite(vertices[faces])) or np.abs(vertices[faces]).max() > 1e9:
        raise ModelFileError(path, "coordinates that are not finite", "finite coordinates")
    used, faces = np.unique(faces, return_inverse=True)
    return vertices[used], faces.reshape(-1, 3)


def find_middle(vertices: Array, faces: Faces) -> Array:
    """(3,) centroid of a surface, each triangle weighted by its area."""
    corners = vertices[faces]
    areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    return areas @ corners.mean(axis=1) / areas.sum()


def is_skinned(gltf: Gltf) -> bool:
    """Whether a glTF holds a skin, as hands do."""
    skins = gltf.document.get("skins")
    return isinstance(skins, list) and len(skins) > 0


def _find_unit(path: Path, vertices: Array, metres_per_unit: float | None) -> tuple[float, str]:
    """Metres per unit and what to tell people of it."""
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    needed = f"an object of {1e3 * SIZES[0]:.0f} mm to {SIZES[1]:.1f} m, or its unit said (metres per unit)"
    if metres_per_unit is not None:
        if not (np.isfinite(metres_per_unit) and metres_per_unit > 0.0):
            raise ModelFileError(path, f"a unit of {metres_per_unit} m", "a positive number of metres")
        if not POSSIBLE_SIZES[0] <= size * metres_per_unit <= POSSIBLE_SIZES[1]:
            raise ModelFileError(path, f"a size of {size * metres_per_unit:.3g} m with the unit given", needed)
        return metres_per_unit, f"{metres_per_unit:g} m, given"
    for name, scale in UNITS:
        if SIZES[0] <= size * scale <= SIZES[1]:
            told = f"{name}, guessed: the object is {size:.4g} units across, {1e3 * size * scale:.4g} mm"
            log.info("%s: unit %s.", path, told)
            return scale, told
    raise ModelFileError(path, f"a size of {size:.4g} units, in no unit that of a thing to hold", needed)


def _read(path: Path) -> tuple[Array, Faces]:
    suffix = path.suffix.lower()
    assert suffix in OBJECT_SUFFIXES
    if suffix == ".off":
        return read_off(path)
    if suffix in (".glb", ".gltf"):
        return _read_static_gltf(read_gltf(path))
    if path.stat().st_size > MAX_BYTES:
        raise ModelFileError(path, f"{path.stat().st_size} bytes", f"at most {MAX_BYTES} bytes")
    # Read from memory, without a resolver: materials and textures that the file names are not looked for.
    options: dict[str, Any] = {"skip_materials": True} if suffix == ".obj" else {}
    mesh = trimesh.load_mesh(io.BytesIO(path.read_bytes()), file_type=suffix[1:], process=False, **options)
    return np.array(mesh.vertices, dtype=np.float64), np.array(mesh.faces, dtype=np.int64).reshape(-1, 3)


def _read_static_gltf(gltf: Gltf) -> tuple[Array, Faces]:
    """All triangles of all nodes, where the nodes put them."""
    nodes = gltf.document.get("nodes", [])
    if not isinstance(nodes, list) or len(nodes) > MAX_NODES:
        raise gltf.fail("nodes that are not a list, or too many", f"at most {MAX_NODES} nodes")
    vertices, faces, start = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.int64)], 0
    for number, node in enumerate(nodes):
        if not isinstance(node, dict) or "mesh" not in node:
            continue
        T = node_to_world(gltf, number)
        for primitive in gltf.primitives(node["mesh"]):
            points, ids = gltf.triangles(primitive)
            if start + len(points) > MAX_VERTICES:
                raise gltf.fail(f"more than {MAX_VERTICES} vertices", "a lighter mesh")
            vertices.append(points @ T[:3, :3].T + T[:3, 3])
            faces.append(ids + start)
            start += len(points)
    return np.concatenate(vertices), np.concatenate(faces)
