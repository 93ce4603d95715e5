"""What speaks for and against a fit: detections, collisions, contacts and distances, drawn and told."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from server.viewer.layers import FINGER_COLORS, WRIST_COLOR, Layers, repeat, term_color
from server.viewer.nodes import SceneNodes

if TYPE_CHECKING:
    from tracker.inspection import FrameView

FULL_MM = 10.0
"""Distance at which the colours of distances end, mm; the same as in the page's error legend."""

DEEPEST_MM = 5.0
"""The same for depths of penetration."""

ERROR_ANCHORS = np.array([(62, 118, 208), (98, 170, 200), (226, 205, 120), (232, 122, 74), (214, 48, 49)], dtype=float)
"""From none to much, as in web/src/model/errorColor.ts."""

LIFT = 0.003
"""m towards the camera; enough for the unknown not to flicker with the cloud that it is part of."""

UNSEEN_COLOR = (120, 126, 134)
"""Skin that the camera cannot see."""


def error_colors(shares: npt.NDArray[Any]) -> npt.NDArray[np.uint8]:
    """(N, 3) colours of errors (N,) from 0 to 1; NaN is grey."""
    at = np.clip(np.nan_to_num(shares, nan=0.0), 0.0, 1.0) * (len(ERROR_ANCHORS) - 1)
    places = np.arange(len(ERROR_ANCHORS))
    colors = np.stack([np.interp(at, places, ERROR_ANCHORS[:, channel]) for channel in range(3)], axis=-1)
    colors[np.isnan(shares)] = UNSEEN_COLOR
    return np.round(colors).astype(np.uint8)


def draw_evidence(nodes: SceneNodes, view: FrameView, layers: Layers) -> None:
    """Draw those of the layers that are on."""
    if layers.detections:
        _draw_detections(nodes, view)
    if layers.collisions:
        _draw_collisions(nodes, view)
    if layers.contacts:
        _draw_contacts(nodes, view)
    if layers.unknown and len(view.unknown.points):
        color = repeat(_unknown_color(), len(view.unknown.points))
        away = view.T_world_camera[:3, 3] - view.unknown.points
        lifted = view.unknown.points + LIFT * away / np.linalg.norm(away, axis=1, keepdims=True)
        nodes.points("/unknown", lifted, color, size=0.0012)
    if layers.distances:
        for model, distances in zip(view.models, view.surface_fit, strict=True):
            colors = error_colors(1000.0 * distances / FULL_MM)
            nodes.colored_mesh(f"/distances/{model.name}", model.vertices, model.faces, colors)


def describe_evidence(view: FrameView, layers: Layers) -> dict[str, Any]:
    """The same in numbers; None for layers that are off."""
    return {
        "detections": _describe_detections(view) if layers.detections else None,
        "collisions": _describe_collisions(view) if layers.collisions else None,
        "contacts": _describe_contacts(view) if layers.contacts else None,
        "unknown": _describe_unknown(view) if layers.unknown else None,
        "distances": _describe_distances(view) if layers.distances else None,
    }


def _draw_detections(nodes: SceneNodes, view: FrameView) -> None:
    found = view.detections
    if not found:
        return
    colors = np.array([FINGER_COLORS.get(item.finger_name, WRIST_COLOR) for item in found], dtype=np.uint8)
    nodes.points("/detections/marks", np.stack([item.position for item in found]), colors, size=0.006)
    sides = np.stack([np.stack([item.box, np.roll(item.box, -1, axis=0)], axis=1) for item in found])
    nodes.segments("/detections/boxes", sides.reshape(-1, 2, 3), np.repeat(colors, 4, axis=0), thickness=0.0008)
    owned = [place for place, item in enumerate(found) if item.model >= 0]
    if owned:
        links = np.stack([np.stack([found[place].position, found[place].tip]) for place in owned])
        nodes.segments("/detections/links", links, colors[owned], thickness=0.0014)
    for place, item in enumerate(found):
        name = item.finger_name or "no finger"
        nodes.label(f"/detections/label-{place}", f"{name} {item.confidence:.1f}", item.box[:2].mean(axis=0))


def _draw_collisions(nodes: SceneNodes, view: FrameView) -> None:
    found = view.collisions
    if len(found.triangles):
        nodes.triangles("/collisions/triangles", found.triangles, term_color("collision"))
        edges = np.stack([found.triangles, np.roll(found.triangles, -1, axis=1)], axis=2).reshape(-1, 2, 3)
        nodes.segments("/collisions/edges", edges, np.full((len(edges), 3), 255, dtype=np.uint8), thickness=0.0003)
    if len(found.vertices):
        colors = error_colors(1000.0 * found.depths / DEEPEST_MM)
        nodes.points("/collisions/vertices", found.vertices, colors, size=0.0024)
    for place, pair in enumerate(pair for pair in found.pairs[:3] if pair.depth > 0.0):
        nodes.label(f"/collisions/label-{place}", f"{1000.0 * pair.depth:.1f} mm", pair.deepest_at)


def _draw_contacts(nodes: SceneNodes, view: FrameView) -> None:
    for is_chosen, kind, color in (
        (True, "chosen", term_color("physics")),
        (False, "considered", WRIST_COLOR),
    ):
        parts = [part for part in view.contacts.contacts if part.is_chosen == is_chosen]
        if not parts:
            continue
        nodes.triangles(f"/contacts/{kind}", np.concatenate([part.triangles for part in parts]), color)
        gaps = np.stack([part.segment for part in parts])
        nodes.points(f"/contacts/{kind}-ends", gaps.reshape(-1, 3), repeat(color, 2 * len(gaps)), size=0.0024)
        nodes.segments(f"/contacts/{kind}-gaps", gaps, repeat(color, len(gaps)), thickness=0.0014)
    for place, part in enumerate(view.contacts.contacts):
        words = part.part.replace("_", " ")
        text = f"{words}, chosen" if part.is_chosen else words
        nodes.label(f"/contacts/label-{place}", text, part.segment[0])


def _describe_detections(view: FrameView) -> dict[str, Any]:
    names, own = view.aids.setup.names, view.aids.setup.own_detector
    return {
        "is_of_run": "S" in view.aids.setup.options.term_letters,
        "own_detector": None if own is None else own.name,
        "items": [
            {
                "hand": names[item.model] if item.model >= 0 else None,
                "finger": item.finger_name or None,
                "color": "#{:02x}{:02x}{:02x}".format(*FINGER_COLORS.get(item.finger_name, WRIST_COLOR)),
                "confidence": round(item.confidence, 2),
                "distance_mm": round(1000.0 * item.distance, 2) if item.model >= 0 else None,
            }
            for item in view.detections
        ],
    }


def _describe_collisions(view: FrameView) -> dict[str, Any]:
    found = view.collisions
    return {
        "is_of_run": "C" in view.aids.setup.options.term_letters,
        "triangles": len(found.triangles),
        "vertices": len(found.vertices),
        "deepest_mm": round(1000.0 * float(found.depths.max(initial=0.0)), 2),
        "full_mm": DEEPEST_MM,
        "pairs": [
            {
                "first": pair.first,
                "second": pair.second,
                "crossings": pair.crossings,
                "deepest_mm": round(1000.0 * pair.depth, 2),
            }
            for pair in found.pairs
        ],
    }


def _describe_contacts(view: FrameView) -> dict[str, Any]:
    from tracker import find_physics_fault

    setup, found = view.aids.setup, view.contacts
    return {
        "is_of_run": "P" in setup.options.term_letters,
        "fault": find_physics_fault(),
        "object": setup.names[found.object] if found.object >= 0 else None,
        "is_stable": found.is_stable,
        "displacement_mm": round(1000.0 * found.displacement, 2),
        "held_displacement_mm": round(1000.0 * found.held_displacement, 2),
        "simulated": found.simulated,
        "parts": [
            {
                "hand": setup.names[part.hand],
                "part": part.part.replace("_", " "),
                "distance_mm": round(1000.0 * part.distance, 2),
                "is_chosen": part.is_chosen,
            }
            for part in found.contacts
        ],
    }


def _unknown_color() -> tuple[int, int, int]:
    from tracker.inspection import UNKNOWN_COLOR

    return UNKNOWN_COLOR


def _describe_unknown(view: FrameView) -> dict[str, Any]:
    found = view.unknown
    return {
        "color": "#{:02x}{:02x}{:02x}".format(*_unknown_color()),
        "pixels": len(found.points),
        "before": found.before,
        "by_color": found.by_color,
    }


def _describe_distances(view: FrameView) -> dict[str, Any]:
    models = []
    for model, distances in zip(view.models, view.surface_fit, strict=True):
        seen = 1000.0 * distances[np.isfinite(distances)]
        models.append(
            {
                "name": model.name,
                "visible_share": round(len(seen) / max(len(distances), 1), 3),
                "median_mm": round(float(np.median(seen)), 2) if len(seen) else None,
                "p95_mm": round(float(np.percentile(seen, 95)), 2) if len(seen) else None,
            }
        )
    return {"full_mm": FULL_MM, "models": models}
