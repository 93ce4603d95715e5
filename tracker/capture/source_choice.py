"""Which joints count, by where they came from: nothing may be judged by what it made itself.

A joint is *independent* when no track had a part in it: placed or moved by hand, imported, never noted, or
triangulated, interpolated or copied from such joints alone. What somebody accepted from a track is not, nor what was
made of that; nor a model fit, which uses the tracker's own hand model and its own objective; nor a joint of the hand
detector, by which the tracker starts and is guided.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TypeVar

import numpy as np
import numpy.typing as npt

from tracker.capture.annotations import Annotations
from tracker.capture.joint_source import SOURCE_KINDS, JointSource, JointSources
from tracker.errors import AnnotationError

Origin = TypeVar("Origin", str, tuple[str, str])

INDEPENDENT, ALL = "independent", "all"
ORIGINS = ("hand", "unknown", *SOURCE_KINDS)
"""Where a joint may have come from; `unknown`: it was not recorded."""
SOURCE_CHOICES = (INDEPENDENT, ALL, *ORIGINS)
"""What can be chosen; of several, a joint counts that is among any."""
MADE = ("track", "fit", "detector")
"""Kinds that the tracker itself, or what guides it, has a part in."""
JUDGING = (INDEPENDENT,)
"""The default of what judges."""

ORIGIN_WORDS = {
    "hand": "placed by hand",
    "unknown": "of unknown origin",
    "track": "accepted from a track",
    "fit": "accepted from a model fit",
    "detector": "accepted from the hand detector",
    "triangulation": "triangulated from other cameras",
    "interpolation": "interpolated between key frames",
    "copy": "copied from another frame",
    "import": "imported",
}


def is_independent(source: JointSource | None) -> bool:
    """Whether no track had a part in a joint that has this source; None: placed by hand."""
    return source is None or source.kind == "import" or (source.kind not in MADE and source.is_independent)


def find_counted(sources: JointSources | None, chosen: Sequence[str]) -> npt.NDArray[np.bool_]:
    """(21,) which joints of a hand are among those chosen (`SOURCE_CHOICES`), placed or not."""
    if ALL in chosen:
        return np.ones(21, dtype=bool)
    return np.array(
        [
            find_origin(sources, joint) in chosen
            or (INDEPENDENT in chosen and (sources is None or is_independent(sources[joint])))
            for joint in range(21)
        ]
    )


def find_origin(sources: JointSources | None, joint: int) -> str:
    """One of ORIGINS."""
    if sources is None:
        return "unknown"
    source = sources[joint]
    return "hand" if source is None else source.kind


def describe_origin(sources: JointSources | None, joint: int) -> str:
    """For people, after a number of joints: "accepted from Track 2", "copied from another frame, made from a track"."""
    origin = find_origin(sources, joint)
    source = None if sources is None else sources[joint]
    if source is not None and origin == "track" and source.label:
        return f"accepted from {source.label}"
    words = ORIGIN_WORDS[origin]
    if origin in ("triangulation", "interpolation", "copy") and not is_independent(source):
        return f"{words} and not known to be free of a track"
    return words


def count_origins(origins: Iterable[Origin]) -> list[tuple[Origin, int]]:
    """Each with how often it is there, the most frequent first."""
    return sorted(Counter(origins).items(), key=lambda item: (-item[1], item[0]))


def say_left_out(counts: Iterable[tuple[str, int]]) -> str:
    """What is left out, in a sentence, from words of `describe_origin` and how many joints; empty for nothing."""
    counts = list(counts)
    if not counts:
        return ""
    parts = ", ".join(f"{count} {words}" for words, count in counts)
    return f"{sum(count for _, count in counts)} joints are left out because of their source: {parts}."


def choose_sources(text: str) -> tuple[str, ...]:
    """From words with commas between, as people write them: `independent`, `all`, `hand,import`."""
    chosen = tuple(word.strip() for word in text.split(",") if word.strip())
    if not chosen or set(chosen) - set(SOURCE_CHOICES):
        raise AnnotationError(f"The sources {text!r} are not known; needed one or more of {', '.join(SOURCE_CHOICES)}.")
    return chosen


def keep_joints(annotations: Annotations, chosen: Sequence[str]) -> tuple[Annotations, list[tuple[str, int]]]:
    """The labels with the joints of these sources alone, and what was left out: words and how many placed joints.

    A joint that is left out is one that nobody looked at; a hand without any other is left out whole.
    """
    kept, gone = [], []
    for item in annotations.items:
        counted = find_counted(item.sources, chosen)
        points = np.where(counted[:, None], item.points, 0.0)
        gone += [describe_origin(item.sources, j) for j in np.flatnonzero(~counted & (item.points[:, 2] > 0)).tolist()]
        sources = item.sources
        if sources is not None:
            sources = tuple(source if is_kept else None for source, is_kept in zip(sources, counted, strict=True))
        if points.any() or not item.points.any():
            kept.append(replace(item, points=points, sources=sources))
    return Annotations(tuple(kept)), count_origins(gone)
