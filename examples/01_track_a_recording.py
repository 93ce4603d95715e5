"""Track a recording: `python examples/01_track_a_recording.py RECORDING OUT`.

Without a recording at hand: `handloom synthesize --motion open-close --out recordings/open-close`.
"""

import sys
from pathlib import Path

from tracker import TrackOptions, join_chunks, load_annotations, load_sequence, start_tracking, track_frames

recording, out = Path(sys.argv[1]), Path(sys.argv[2])
sequence = load_sequence(recording)
options = TrackOptions(iterations=10)

# The start: the annotation of the first frame if somebody made one, the depth image alone otherwise.
path = sequence.annotations_path
annotations = load_annotations(path) if path and path.exists() else None
setup, state = start_tracking(sequence, options, annotations=annotations)

frames = options.frame_range(sequence.frame_count)
state, chunk = track_frames(
    sequence, setup, state, frames, lambda frame, result: print(f"frame {frame}: {result.status}", end="\r")
)
track = join_chunks(sequence, setup, [chunk])
track.save(out)
print(f"\n{len(track.frame)} frames in {out}")
