"""Track every recording of a studio: `python examples/04_track_in_a_studio.py URL OUT [WORDS OF NAMES]`.

A studio that asks for a login takes a token in HANDLOOM_TOKEN.
"""

import os
import sys
from pathlib import Path

from server.client import Studio

url, out, words = sys.argv[1], Path(sys.argv[2]), " ".join(sys.argv[3:])

with Studio(url, os.environ.get("HANDLOOM_TOKEN")) as studio:
    recordings = {item["id"]: item["name"] for item in studio.recordings(words or None)}
    for job in studio.jobs.track_all(recordings, calibrate=False):
        name = recordings[job["sequence_id"]]
        done = studio.jobs.wait(job["id"], lambda job, name=name: print(f"{name}: {job['progress']:.0%}", end="\r"))
        folder = studio.download_track(done["track_id"], out / name)
        print(f"{name}: {done['frames_done']} frames in {folder}")
