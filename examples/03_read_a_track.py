"""Read a track and follow one fingertip: `python examples/03_read_a_track.py TRACK`."""

import sys
from pathlib import Path

import numpy as np

with np.load(Path(sys.argv[1]) / "track.npz") as track:
    names = [str(name) for name in track["joint_names"]]
    tip = track["joints_3d"][:, names.index("right/index_tip")]  # (T, 3) world, m
    status = track["status"]
    frames = track["frame"]

speed = np.linalg.norm(np.diff(tip, axis=0), axis=1)
print(f"{len(frames)} frames, {np.sum(status == 'lost')} lost")
print(f"the tip of the index finger moved {speed.sum():.3f} m; fastest after frame {frames[np.argmax(speed)]}")
