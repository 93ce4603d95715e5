"""Handloom's science: frames and scans in, poses and models out. Runs without the server.

What other programs may use is listed here and loaded when it is first asked for: `import tracker` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from tracker.kernel_cache import use_kernel_cache

if TYPE_CHECKING:
    from tracker.calibration.board import BOARD_KINDS, Board, list_dictionaries
    from tracker.calibration.board_file import read_board
    from tracker.calibration.board_pattern import draw_board
    from tracker.calibration.board_pdf import make_board_pdf
    from tracker.calibration.calibrate import CalibrationOptions, calibrate_cameras
    from tracker.calibration.calibration_output import encode_cameras, encode_report, write_calibration
    from tracker.calibration.calibration_report import describe_calibration, say_calibration
    from tracker.calibration.camera_calibration import CameraCalibration
    from tracker.calibration.camera_source import MAX_CAMERAS, CameraSource, find_sources, open_source
    from tracker.calibration.coverage import encode_coverage
    from tracker.calibration.film_folder import FilmFolder, list_films
    from tracker.calibration.known_lenses import load_lenses
    from tracker.calibration.refine_cameras import refine_cameras
    from tracker.calibration.sightings import Sightings, find_sightings
    from tracker.calibration.source_check import SourceCheck, check_sources
    from tracker.capture.annotations import Annotation, Annotations, load_annotations, save_annotations
    from tracker.capture.archive import ArchiveLimits, extract_archive
    from tracker.capture.camera import Camera
    from tracker.capture.frame import Frame
    from tracker.capture.import_check import IMPORT_FORMATS, check_import
    from tracker.capture.import_options import ImportOptions
    from tracker.capture.import_picture import read_import_picture
    from tracker.capture.import_plan import StreamProbe
    from tracker.capture.import_report import ImportReport
    from tracker.capture.import_run import run_import
    from tracker.capture.joint_source import JointSource, JointSources
    from tracker.capture.relative_path import find_path_fault
    from tracker.capture.scan import SCAN_SUFFIXES, Scan, find_unit, load_scan, read_scan, save_scan
    from tracker.capture.scan_size import (
        HAND_LENGTHS,
        LONGEST_SCENE,
        SIZES_NEEDED,
        find_possible_units,
        find_size_fault,
        is_certain,
        measure_size,
        write_length,
    )
    from tracker.capture.sensor_presets import SENSOR_PRESETS, SensorPreset
    from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json
    from tracker.capture.source_choice import (
        JUDGING,
        SOURCE_CHOICES,
        choose_sources,
        count_origins,
        describe_origin,
        find_counted,
        find_origin,
        is_independent,
        keep_joints,
        say_left_out,
    )
    from tracker.capture.triangulation import Triangulation, triangulate
    from tracker.cli import add_commands
    from tracker.detection.image_hands import DETECTOR_LABEL, find_image_hands
    from tracker.detection.own_detector import OwnDetector, load_detector
    from tracker.detection.recorded_hands import (
        RecordedHands,
        choose_views,
        detect_hands,
        join_recorded_hands,
        load_recorded_hands,
    )
    from tracker.errors import (
        AnnotationError,
        FrameError,
        ImportRefusedError,
        RegistrationError,
        ScanError,
        SequenceError,
        TrackerError,
        TrackingError,
        TrainingError,
        say_count,
    )
    from tracker.evaluation.comparison import JudgedTrack, compare_tracks
    from tracker.evaluation.evaluation import Evaluation, evaluate_track
    from tracker.evaluation.held_out import HeldOut, choose_held_out, make_test_hand
    from tracker.evaluation.held_out_study import STUDY_LEVELS, study_held_out
    from tracker.evaluation.model_report_html import write_model_html
    from tracker.evaluation.model_study import generalize_shapes
    from tracker.evaluation.report_csv import write_csv
    from tracker.evaluation.report_html import write_html
    from tracker.evaluation.worst_picture import draw_item, encode_jpeg
    from tracker.export.export import EXPORT_KINDS, export_track
    from tracker.fitting.options import TrackOptions
    from tracker.fitting.presets import PRESETS, USUAL_PRESET, TrackPreset
    from tracker.fitting.setup import TrackSetup
    from tracker.fitting.tracking_faults import find_detector_faults, find_tracking_faults
    from tracker.inspection.frame_view import (
        UNKNOWN_COLOR,
        FrameView,
        ModelView,
        describe_frame,
        render_overlay,
        render_unknown,
    )
    from tracker.inspection.view_aids import ViewAids
    from tracker.label_formats.formats import LABEL_FORMATS, LabelFormat, export_labels, import_labels
    from tracker.label_formats.image_names import list_image_names
    from tracker.label_formats.label_files import pack_files, read_label_files, save_label_files
    from tracker.label_formats.label_set import ExportedLabels, ImportedLabels, ImportHints, LabelSet
    from tracker.label_formats.orders import JOINT_ORDERS
    from tracker.landmarks import DetectedHand, default_hand_detector
    from tracker.model.articulated import ArticulatedModel
    from tracker.model.blend_articulated import articulated_of
    from tracker.model.blend_files import load_blend_model, save_blend_model
    from tracker.model.blend_mirroring import mirror_blend
    from tracker.model.blend_model import BlendModel
    from tracker.model.default_hand import default_hand
    from tracker.model.files import measure_model
    from tracker.model.joints import HAND_EDGES, HAND_JOINTS
    from tracker.model.mano_files import load_mano
    from tracker.model.mano_writer import save_mano
    from tracker.model.object_files import ObjectSize
    from tracker.model.trained_hand import trained_hand
    from tracker.model.untrained_hand import untrained_hand
    from tracker.physics.bullet import find_physics_fault
    from tracker.registration.anatomy import make_anatomical_prior
    from tracker.registration.options import RegistrationOptions
    from tracker.registration.pose_prior import make_gaussian_prior
    from tracker.registration.register import register_scan
    from tracker.registration.registration import Registration, RegistrationStart
    from tracker.registration.registration_files import (
        load_registration,
        save_registration,
        summarize_registration,
    )
    from tracker.registration.scan_points import find_hand_points
    from tracker.tracking.chunk import TrackChunk
    from tracker.tracking.follow import track_frames
    from tracker.tracking.frame_result import FrameResult
    from tracker.tracking.quick_fit import MIN_FIT_JOINTS, QuickFit, fit_marked, view_track_hands
    from tracker.tracking.start import start_tracking
    from tracker.tracking.start_plan import plan_start
    from tracker.tracking.state import TrackState
    from tracker.tracking.track import Track, join_chunks, load_track
    from tracker.tracking.warm_up import warm_up
    from tracker.training.checkpoints import Checkpoints, pack_arrays, unpack_arrays
    from tracker.training.options import TrainingOptions
    from tracker.training.train import Training, train_model
    from tracker.training.training_faults import TrainingHand, find_bend_fault, find_training_faults
    from tracker.training.training_set import TrainingSet, load_training_set, make_training_set

_HOMES = {
    "Board": "tracker.calibration.board",
    "BOARD_KINDS": "tracker.calibration.board",
    "list_dictionaries": "tracker.calibration.board",
    "draw_board": "tracker.calibration.board_pattern",
    "read_board": "tracker.calibration.board_file",
    "make_board_pdf": "tracker.calibration.board_pdf",
    "CalibrationOptions": "tracker.calibration.calibrate",
    "calibrate_cameras": "tracker.calibration.calibrate",
    "CameraCalibration": "tracker.calibration.camera_calibration",
    "describe_calibration": "tracker.calibration.calibration_report",
    "say_calibration": "tracker.calibration.calibration_report",
    "encode_cameras": "tracker.calibration.calibration_output",
    "encode_report": "tracker.calibration.calibration_output",
    "write_calibration": "tracker.calibration.calibration_output",
    "encode_coverage": "tracker.calibration.coverage",
    "refine_cameras": "tracker.calibration.refine_cameras",
    "CameraSource": "tracker.calibration.camera_source",
    "MAX_CAMERAS": "tracker.calibration.camera_source",
    "open_source": "tracker.calibration.camera_source",
    "find_sources": "tracker.calibration.camera_source",
    "Sightings": "tracker.calibration.sightings",
    "find_sightings": "tracker.calibration.sightings",
    "SourceCheck": "tracker.calibration.source_check",
    "check_sources": "tracker.calibration.source_check",
    "FilmFolder": "tracker.calibration.film_folder",
    "list_films": "tracker.calibration.film_folder",
    "load_lenses": "tracker.calibration.known_lenses",
    "DETECTOR_LABEL": "tracker.detection.image_hands",
    "find_image_hands": "tracker.detection.image_hands",
    "choose_views": "tracker.detection.recorded_hands",
    "detect_hands": "tracker.detection.recorded_hands",
    "join_recorded_hands": "tracker.detection.recorded_hands",
    "load_recorded_hands": "tracker.detection.recorded_hands",
    "RecordedHands": "tracker.detection.recorded_hands",
    "DetectedHand": "tracker.landmarks",
    "default_hand_detector": "tracker.landmarks",
    "plan_start": "tracker.tracking.start_plan",
    "find_tracking_faults": "tracker.fitting.tracking_faults",
    "find_detector_faults": "tracker.fitting.tracking_faults",
    "load_detector": "tracker.detection.own_detector",
    "OwnDetector": "tracker.detection.own_detector",
    "find_training_faults": "tracker.training.training_faults",
    "find_bend_fault": "tracker.training.training_faults",
    "TrainingHand": "tracker.training.training_faults",
    "write_model_html": "tracker.evaluation.model_report_html",
    "study_held_out": "tracker.evaluation.held_out_study",
    "STUDY_LEVELS": "tracker.evaluation.held_out_study",
    "make_test_hand": "tracker.evaluation.held_out",
    "choose_held_out": "tracker.evaluation.held_out",
    "HeldOut": "tracker.evaluation.held_out",
    "add_commands": "tracker.cli",
    "Annotation": "tracker.capture.annotations",
    "AnnotationError": "tracker.errors",
    "Annotations": "tracker.capture.annotations",
    "ArchiveLimits": "tracker.capture.archive",
    "ArticulatedModel": "tracker.model.articulated",
    "BlendModel": "tracker.model.blend_model",
    "Camera": "tracker.capture.camera",
    "articulated_of": "tracker.model.blend_articulated",
    "check_import": "tracker.capture.import_check",
    "Checkpoints": "tracker.training.checkpoints",
    "pack_arrays": "tracker.training.checkpoints",
    "unpack_arrays": "tracker.training.checkpoints",
    "compare_tracks": "tracker.evaluation.comparison",
    "default_hand": "tracker.model.default_hand",
    "describe_frame": "tracker.inspection.frame_view",
    "draw_item": "tracker.evaluation.worst_picture",
    "encode_jpeg": "tracker.evaluation.worst_picture",
    "evaluate_track": "tracker.evaluation.evaluation",
    "Evaluation": "tracker.evaluation.evaluation",
    "EXPORT_KINDS": "tracker.export.export",
    "export_labels": "tracker.label_formats.formats",
    "export_track": "tracker.export.export",
    "ExportedLabels": "tracker.label_formats.label_set",
    "extract_archive": "tracker.capture.archive",
    "find_hand_points": "tracker.registration.scan_points",
    "find_path_fault": "tracker.capture.relative_path",
    "fit_marked": "tracker.tracking.quick_fit",
    "Frame": "tracker.capture.frame",
    "FrameError": "tracker.errors",
    "FrameResult": "tracker.tracking.frame_result",
    "FrameView": "tracker.inspection.frame_view",
    "HAND_EDGES": "tracker.model.joints",
    "HAND_JOINTS": "tracker.model.joints",
    "IMPORT_FORMATS": "tracker.capture.import_check",
    "generalize_shapes": "tracker.evaluation.model_study",
    "import_labels": "tracker.label_formats.formats",
    "ImportedLabels": "tracker.label_formats.label_set",
    "ImportHints": "tracker.label_formats.label_set",
    "ImportOptions": "tracker.capture.import_options",
    "ImportRefusedError": "tracker.errors",
    "ImportReport": "tracker.capture.import_report",
    "join_chunks": "tracker.tracking.track",
    "JOINT_ORDERS": "tracker.label_formats.orders",
    "JointSource": "tracker.capture.joint_source",
    "JointSources": "tracker.capture.joint_source",
    "JudgedTrack": "tracker.evaluation.comparison",
    "LABEL_FORMATS": "tracker.label_formats.formats",
    "LabelFormat": "tracker.label_formats.formats",
    "LabelSet": "tracker.label_formats.label_set",
    "list_image_names": "tracker.label_formats.image_names",
    "load_annotations": "tracker.capture.annotations",
    "load_mano": "tracker.model.mano_files",
    "load_blend_model": "tracker.model.blend_files",
    "load_registration": "tracker.registration.registration_files",
    "load_scan": "tracker.capture.scan",
    "read_scan": "tracker.capture.scan",
    "find_unit": "tracker.capture.scan",
    "HAND_LENGTHS": "tracker.capture.scan_size",
    "LONGEST_SCENE": "tracker.capture.scan_size",
    "SIZES_NEEDED": "tracker.capture.scan_size",
    "find_physics_fault": "tracker.physics.bullet",
    "find_possible_units": "tracker.capture.scan_size",
    "find_size_fault": "tracker.capture.scan_size",
    "is_certain": "tracker.capture.scan_size",
    "measure_model": "tracker.model.files",
    "ObjectSize": "tracker.model.object_files",
    "measure_size": "tracker.capture.scan_size",
    "write_length": "tracker.capture.scan_size",
    "load_sequence": "tracker.capture.sequence",
    "load_training_set": "tracker.training.training_set",
    "load_track": "tracker.tracking.track",
    "make_anatomical_prior": "tracker.registration.anatomy",
    "make_gaussian_prior": "tracker.registration.pose_prior",
    "MIN_FIT_JOINTS": "tracker.tracking.quick_fit",
    "ModelView": "tracker.inspection.frame_view",
    "mirror_blend": "tracker.model.blend_mirroring",
    "pack_files": "tracker.label_formats.label_files",
    "PRESETS": "tracker.fitting.presets",
    "QuickFit": "tracker.tracking.quick_fit",
    "read_label_files": "tracker.label_formats.label_files",
    "read_import_picture": "tracker.capture.import_picture",
    "SENSOR_PRESETS": "tracker.capture.sensor_presets",
    "SensorPreset": "tracker.capture.sensor_presets",
    "StreamProbe": "tracker.capture.import_plan",
    "say_count": "tracker.errors",
    "register_scan": "tracker.registration.register",
    "Registration": "tracker.registration.registration",
    "RegistrationError": "tracker.errors",
    "RegistrationOptions": "tracker.registration.options",
    "RegistrationStart": "tracker.registration.registration",
    "render_overlay": "tracker.inspection.frame_view",
    "render_unknown": "tracker.inspection.frame_view",
    "UNKNOWN_COLOR": "tracker.inspection.frame_view",
    "run_import": "tracker.capture.import_run",
    "save_annotations": "tracker.capture.annotations",
    "save_mano": "tracker.model.mano_writer",
    "save_blend_model": "tracker.model.blend_files",
    "save_label_files": "tracker.label_formats.label_files",
    "save_registration": "tracker.registration.registration_files",
    "save_scan": "tracker.capture.scan",
    "save_sequence_json": "tracker.capture.sequence",
    "Scan": "tracker.capture.scan",
    "SCAN_SUFFIXES": "tracker.capture.scan",
    "ScanError": "tracker.errors",
    "Sequence": "tracker.capture.sequence",
    "SequenceError": "tracker.errors",
    "start_tracking": "tracker.tracking.start",
    "summarize_registration": "tracker.registration.registration_files",
    "Track": "tracker.tracking.track",
    "track_frames": "tracker.tracking.follow",
    "TrackChunk": "tracker.tracking.chunk",
    "TrackerError": "tracker.errors",
    "TrackingError": "tracker.errors",
    "TrackOptions": "tracker.fitting.options",
    "TrackPreset": "tracker.fitting.presets",
    "TrackSetup": "tracker.fitting.setup",
    "TrackState": "tracker.tracking.state",
    "make_training_set": "tracker.training.training_set",
    "train_model": "tracker.training.train",
    "triangulate": "tracker.capture.triangulation",
    "Training": "tracker.training.train",
    "TrainingError": "tracker.errors",
    "TrainingOptions": "tracker.training.options",
    "TrainingSet": "tracker.training.training_set",
    "Triangulation": "tracker.capture.triangulation",
    "trained_hand": "tracker.model.trained_hand",
    "untrained_hand": "tracker.model.untrained_hand",
    "USUAL_PRESET": "tracker.fitting.presets",
    "view_track_hands": "tracker.tracking.quick_fit",
    "ViewAids": "tracker.inspection.view_aids",
    "warm_up": "tracker.tracking.warm_up",
    "JUDGING": "tracker.capture.source_choice",
    "SOURCE_CHOICES": "tracker.capture.source_choice",
    "choose_sources": "tracker.capture.source_choice",
    "count_origins": "tracker.capture.source_choice",
    "describe_origin": "tracker.capture.source_choice",
    "find_counted": "tracker.capture.source_choice",
    "find_origin": "tracker.capture.source_choice",
    "is_independent": "tracker.capture.source_choice",
    "keep_joints": "tracker.capture.source_choice",
    "say_left_out": "tracker.capture.source_choice",
    "write_csv": "tracker.evaluation.report_csv",
    "write_html": "tracker.evaluation.report_html",
}

__all__ = [
    "BOARD_KINDS",
    "DETECTOR_LABEL",
    "EXPORT_KINDS",
    "HAND_EDGES",
    "HAND_JOINTS",
    "HAND_LENGTHS",
    "IMPORT_FORMATS",
    "JOINT_ORDERS",
    "JUDGING",
    "LABEL_FORMATS",
    "LONGEST_SCENE",
    "MAX_CAMERAS",
    "MIN_FIT_JOINTS",
    "PRESETS",
    "SCAN_SUFFIXES",
    "SENSOR_PRESETS",
    "SIZES_NEEDED",
    "SOURCE_CHOICES",
    "STUDY_LEVELS",
    "UNKNOWN_COLOR",
    "USUAL_PRESET",
    "Annotation",
    "AnnotationError",
    "Annotations",
    "ArchiveLimits",
    "ArticulatedModel",
    "BlendModel",
    "Board",
    "CalibrationOptions",
    "Camera",
    "CameraCalibration",
    "CameraSource",
    "Checkpoints",
    "DetectedHand",
    "Evaluation",
    "ExportedLabels",
    "FilmFolder",
    "Frame",
    "FrameError",
    "FrameResult",
    "FrameView",
    "HeldOut",
    "ImportHints",
    "ImportOptions",
    "ImportRefusedError",
    "ImportReport",
    "ImportedLabels",
    "JointSource",
    "JointSources",
    "JudgedTrack",
    "LabelFormat",
    "LabelSet",
    "ModelView",
    "ObjectSize",
    "OwnDetector",
    "QuickFit",
    "RecordedHands",
    "Registration",
    "RegistrationError",
    "RegistrationOptions",
    "RegistrationStart",
    "Scan",
    "ScanError",
    "SensorPreset",
    "Sequence",
    "SequenceError",
    "Sightings",
    "SourceCheck",
    "StreamProbe",
    "Track",
    "TrackChunk",
    "TrackOptions",
    "TrackPreset",
    "TrackSetup",
    "TrackState",
    "TrackerError",
    "TrackingError",
    "Training",
    "TrainingError",
    "TrainingHand",
    "TrainingOptions",
    "TrainingSet",
    "Triangulation",
    "ViewAids",
    "add_commands",
    "articulated_of",
    "calibrate_cameras",
    "check_import",
    "check_sources",
    "choose_held_out",
    "choose_sources",
    "choose_views",
    "compare_tracks",
    "count_origins",
    "default_hand",
    "default_hand_detector",
    "describe_calibration",
    "describe_frame",
    "describe_origin",
    "detect_hands",
    "draw_board",
    "draw_item",
    "encode_cameras",
    "encode_coverage",
    "encode_jpeg",
    "encode_report",
    "evaluate_track",
    "export_labels",
    "export_track",
    "extract_archive",
    "find_bend_fault",
    "find_counted",
    "find_detector_faults",
    "find_hand_points",
    "find_image_hands",
    "find_origin",
    "find_path_fault",
    "find_physics_fault",
    "find_possible_units",
    "find_sightings",
    "find_size_fault",
    "find_sources",
    "find_tracking_faults",
    "find_training_faults",
    "find_unit",
    "fit_marked",
    "generalize_shapes",
    "import_labels",
    "is_certain",
    "is_independent",
    "join_chunks",
    "join_recorded_hands",
    "keep_joints",
    "list_dictionaries",
    "list_films",
    "list_image_names",
    "load_annotations",
    "load_blend_model",
    "load_detector",
    "load_lenses",
    "load_mano",
    "load_recorded_hands",
    "load_registration",
    "load_scan",
    "load_sequence",
    "load_track",
    "load_training_set",
    "make_anatomical_prior",
    "make_board_pdf",
    "make_gaussian_prior",
    "make_test_hand",
    "make_training_set",
    "measure_model",
    "measure_size",
    "mirror_blend",
    "open_source",
    "pack_arrays",
    "pack_files",
    "plan_start",
    "read_board",
    "read_import_picture",
    "read_label_files",
    "read_scan",
    "refine_cameras",
    "register_scan",
    "render_overlay",
    "render_unknown",
    "run_import",
    "save_annotations",
    "save_blend_model",
    "save_label_files",
    "save_mano",
    "save_registration",
    "save_scan",
    "save_sequence_json",
    "say_calibration",
    "say_count",
    "say_left_out",
    "start_tracking",
    "study_held_out",
    "summarize_registration",
    "track_frames",
    "train_model",
    "trained_hand",
    "triangulate",
    "unpack_arrays",
    "untrained_hand",
    "view_track_hands",
    "warm_up",
    "write_calibration",
    "write_csv",
    "write_html",
    "write_length",
    "write_model_html",
]


use_kernel_cache()


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module 'tracker' has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(_HOMES[name]), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
