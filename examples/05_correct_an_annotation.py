"""Move a joint of a stored annotation by a pixel, unless somebody else changes it meanwhile.

`python examples/05_correct_an_annotation.py URL RECORDING`. A studio that asks for a login takes a token in
HANDLOOM_TOKEN.
"""

import os
import sys

from server.client import StaleError, Studio

with Studio(sys.argv[1], os.environ.get("HANDLOOM_TOKEN")) as studio:
    annotations = studio.annotations(studio.recording(sys.argv[2])["id"])
    first = next(iter(annotations))
    place = (first["camera"], first["frame"], first["hand"])
    points = [list(point) for point in first["points"]]
    points[0][0] += 1.0
    try:
        stored = annotations.put(*place, points, revision=first["revision"])
        print(f"revision {stored['revision']}: the wrist is at {stored['points'][0][:2]}")
    except StaleError as stale:
        print(f"not stored: {stale.detail} Theirs is revision {stale.theirs['revision']}.")
