"""Cameras, frames, sequences and importers: bytes in, frames out."""

from tracker.capture.annotations import Annotation as Annotation
from tracker.capture.annotations import Annotations as Annotations
from tracker.capture.annotations import load_annotations as load_annotations
from tracker.capture.annotations import save_annotations as save_annotations
from tracker.capture.archive import ArchiveLimits as ArchiveLimits
from tracker.capture.archive import extract_archive as extract_archive
from tracker.capture.camera import Camera as Camera
from tracker.capture.frame import Frame as Frame
from tracker.capture.frame_pattern import FramePattern as FramePattern
from tracker.capture.frame_pattern import parse_pattern as parse_pattern
from tracker.capture.import_check import IMPORT_FORMATS as IMPORT_FORMATS
from tracker.capture.import_check import check_import as check_import
from tracker.capture.import_options import ImportOptions as ImportOptions
from tracker.capture.import_report import ImportReport as ImportReport
from tracker.capture.import_run import run_import as run_import
from tracker.capture.recorded_camera import RecordedCamera as RecordedCamera
from tracker.capture.recorded_object import RecordedObject as RecordedObject
from tracker.capture.relative_path import find_path_fault as find_path_fault
from tracker.capture.sequence import Sequence as Sequence
from tracker.capture.sequence import load_sequence as load_sequence
from tracker.capture.sequence import save_sequence_json as save_sequence_json
from tracker.capture.triangulation import Triangulation as Triangulation
from tracker.capture.triangulation import triangulate as triangulate
from tracker.capture.workplace import clean_leftovers as clean_leftovers
