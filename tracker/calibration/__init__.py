"""Cameras from filmed boards: lenses, places, time offsets, and how well they agree on frames that were left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.calibration.board import Board, list_dictionaries
    from tracker.calibration.board_pattern import draw_board
    from tracker.calibration.board_pdf import make_board_pdf
    from tracker.calibration.calibrate import CalibrationOptions, calibrate_cameras
    from tracker.calibration.calibration_output import encode_cameras, encode_report
    from tracker.calibration.camera_calibration import CameraCalibration
    from tracker.calibration.camera_source import MAX_CAMERAS, CameraSource, open_source
    from tracker.calibration.coverage import encode_coverage
    from tracker.calibration.film_folder import FilmFolder, list_films
    from tracker.calibration.known_lenses import load_lenses
    from tracker.calibration.sightings import Sightings, find_sightings
    from tracker.calibration.source_check import SourceCheck, check_sources

__getattr__, __dir__ = offer(__name__)
