"""Cameras, frames, sequences and importers: bytes in, frames out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.capture.annotations import Annotation, Annotations, load_annotations, save_annotations
    from tracker.capture.archive import ArchiveLimits, extract_archive
    from tracker.capture.camera import Camera
    from tracker.capture.frame import Frame
    from tracker.capture.frame_pattern import FramePattern, parse_pattern
    from tracker.capture.import_check import check_import
    from tracker.capture.import_options import ImportOptions
    from tracker.capture.import_picture import read_import_picture
    from tracker.capture.import_plan import StreamProbe
    from tracker.capture.import_report import ImportReport
    from tracker.capture.import_run import run_import
    from tracker.capture.importers import IMPORT_FORMATS
    from tracker.capture.joint_source import JointSource, JointSources
    from tracker.capture.recorded_camera import RecordedCamera
    from tracker.capture.recorded_object import RecordedObject
    from tracker.capture.relative_path import find_path_fault
    from tracker.capture.scan import find_unit
    from tracker.capture.scan_size import (
        HAND_LENGTHS,
        LONGEST_SCENE,
        SIZES_NEEDED,
        find_possible_units,
        find_size_fault,
        is_certain,
        measure_size,
    )
    from tracker.capture.sensor_presets import SENSOR_PRESETS
    from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json
    from tracker.capture.source_choice import (
        JUDGING,
        choose_sources,
        count_origins,
        describe_origin,
        find_counted,
        find_origin,
        say_left_out,
    )
    from tracker.capture.triangulation import Triangulation, triangulate
    from tracker.capture.workplace import clean_leftovers

__getattr__, __dir__ = offer(__name__)
