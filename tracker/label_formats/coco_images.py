"""The `images` of COCO files: every labelled image once, found again by its file name first."""

from __future__ import annotations

from typing import Any

from tracker.capture.document import Node
from tracker.label_formats.image_names import Place
from tracker.label_formats.label_set import ImportCollector, ImportHints, LabelSet
from tracker.label_formats.values import MAX_ENTRIES

MAX_ID = 2**53
"""The largest whole number that JSON readers keep exact."""


def list_images(sets: list[LabelSet]) -> tuple[list[dict[str, Any]], dict[tuple[str, Place], int]]:
    """Images with labels, and their ids. With several recordings a file name begins with the recording's name and id.

    `sequence`, `camera` and `frame` are ours: other programs pass over them, and we know our own again by them.
    """
    images: list[dict[str, Any]] = []
    ids: dict[tuple[str, Place], int] = {}
    for item in sets:
        prefix = f"{_plain(item.sequence.name)}-{item.key[:8]}/" if len(sets) > 1 else ""
        for place in sorted({(a.camera, a.frame) for a in item.annotations.items}, key=lambda p: (p[1], p[0])):
            camera = item.sequence.camera(place[0])
            ids[item.key, place] = len(images) + 1
            images.append(
                {
                    "id": len(images) + 1,
                    "file_name": prefix + item.names.name(place),
                    "width": camera.width,
                    "height": camera.height,
                    "sequence": item.key,
                    "camera": place[0],
                    "frame": place[1],
                }
            )
    return images, ids


def read_images(node: Node, collector: ImportCollector, hints: ImportHints) -> dict[int, tuple[str, Place]]:
    """Recording, camera and frame of each image id. Images that cannot be found are noted and left out."""
    found: dict[int, tuple[str, Place]] = {}
    for image in node.items(MAX_ENTRIES):
        id_ = image.get("id").integer(0, MAX_ID)
        if id_ in found:
            image.get("id").fail("an id that no other image has")
        name = image.get("file_name").text(1024)
        place = _find_place(image, name, collector, hints)
        if place is None:
            continue
        camera = collector.sets[place[0]].sequence.camera(place[1][0])
        size = tuple(image.get(key).value if image.has(key) else None for key in ("width", "height"))
        if None not in size and size != (camera.width, camera.height):
            collector.problems.add(
                "{n} [image has|images have] another size than in the recording; scaled images cannot be matched",
                f"{name}: {size[0]}x{size[1]}, recorded {camera.width}x{camera.height}",
            )
            continue
        found[id_] = place
    return found


def _find_place(image: Node, name: str, collector: ImportCollector, hints: ImportHints) -> tuple[str, Place] | None:
    """By the file name; where that is not known, by the index that our own files carry."""
    keys = [key for key in collector.sets if not image.has("sequence") or image.get("sequence").value == key]
    if not keys and len(collector.sets) == 1:  # written from another copy of the recording
        keys = list(collector.sets)
    told = image.get("camera").value if image.has("camera") else hints.camera
    matches = [(key, place) for key in keys for place in collector.sets[key].names.find(name, told)]
    indexed = _find_index(image, keys, collector, told)
    if len(matches) > 1 and indexed in matches:
        return indexed
    if len(matches) == 1:
        if indexed is not None and indexed != matches[0]:
            collector.warnings.add(
                "{n} [image was|images were] taken by file name although [its|their] frame number says otherwise", name
            )
        return matches[0]
    if matches:
        collector.problems.add(
            "{n} [file name means|file names mean] several images of the recording; name the camera", name
        )
        return None
    if indexed is not None:
        collector.warnings.add("{n} [file name is|file names are] not known here; the frame number was taken", name)
        return indexed
    collector.warnings.add("{n} [image is|images are] not in the recording; [its|their] labels were left out", name)
    return None


def _find_index(image: Node, keys: list[str], collector: ImportCollector, camera: Any) -> tuple[str, Place] | None:
    frame = image.get("frame").value if image.has("frame") else None
    if type(frame) is not int or len(keys) != 1:
        return None
    sequence = collector.sets[keys[0]].sequence
    known = [item.id for item in sequence.cameras]
    if camera not in known or not 0 <= frame < sequence.frame_count:
        return None
    return keys[0], (camera, frame)


def _plain(name: str) -> str:
    return "".join(c if c.isalnum() or c in "._-" else "_" for c in name)[:80]
