"""Cameras, frames, sequences and importers: bytes in, frames out."""

from tracker.capture.annotations import Annotation as Annotation
from tracker.capture.annotations import Annotations as Annotations
from tracker.capture.annotations import load_annotations as load_annotations
from tracker.capture.annotations import save_annotations as save_annotations
from tracker.capture.camera import Camera as Camera
from tracker.capture.frame import Frame as Frame
from tracker.capture.frame_pattern import FramePattern as FramePattern
from tracker.capture.frame_pattern import parse_pattern as parse_pattern
from tracker.capture.recorded_camera import RecordedCamera as RecordedCamera
from tracker.capture.recorded_object import RecordedObject as RecordedObject
from tracker.capture.sequence import Sequence as Sequence
from tracker.capture.sequence import load_sequence as load_sequence
from tracker.capture.sequence import save_sequence_json as save_sequence_json
