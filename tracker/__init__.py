"""Handloom's science: frames and scans in, poses and models out. Runs without the server.

What other programs may use is listed here, and in the rooms `calibration`, `capture`, `detection`, `evaluation`,
`inspection`, `label_formats`, `landmarks` and `training` for what is theirs alone. It is loaded when it is first asked
for: `import tracker` costs nothing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tracker.kernel_cache import use_kernel_cache
from tracker.lazy_names import offer

if TYPE_CHECKING:
    from tracker.calibration.refine_cameras import refine_cameras
    from tracker.capture.annotations import Annotation, Annotations, load_annotations
    from tracker.capture.camera import Camera
    from tracker.capture.frame import Frame
    from tracker.capture.scan import Scan, read_scan
    from tracker.capture.sequence import Sequence, load_sequence, save_sequence_json
    from tracker.cli import add_commands
    from tracker.errors import FrameError, ImportRefusedError, TrackerError, say_count
    from tracker.export.export import EXPORT_KINDS, export_track
    from tracker.fitting.options import TrackOptions
    from tracker.fitting.presets import PRESETS, USUAL_PRESET
    from tracker.fitting.setup import TrackSetup
    from tracker.fitting.tracking_faults import find_detector_faults, find_tracking_faults
    from tracker.model.articulated import ArticulatedModel
    from tracker.model.blend_articulated import articulated_of
    from tracker.model.blend_files import load_blend_model, save_blend_model
    from tracker.model.blend_mirroring import mirror_blend
    from tracker.model.blend_model import BlendModel
    from tracker.model.built_in_hands import BUILT_IN_HANDS
    from tracker.model.default_hand import default_hand
    from tracker.model.files import measure_model
    from tracker.model.joints import HAND_EDGES, HAND_JOINTS
    from tracker.model.mano_files import load_mano
    from tracker.model.mano_writer import save_mano
    from tracker.model.object_files import ObjectSize
    from tracker.model.untrained_hand import untrained_hand
    from tracker.physics.bullet import find_physics_fault
    from tracker.registration.options import RegistrationOptions
    from tracker.registration.register import Registrar
    from tracker.registration.registration import Registration, RegistrationStart
    from tracker.registration.registration_files import load_registration, save_registration
    from tracker.registration.scan_points import find_hand_points
    from tracker.tracking.chunk import TrackChunk
    from tracker.tracking.follow import track_frames
    from tracker.tracking.quick_fit import MIN_FIT_JOINTS, QuickFit, fit_marked, view_track_hands
    from tracker.tracking.start import start_tracking
    from tracker.tracking.start_plan import plan_start
    from tracker.tracking.state import TrackState
    from tracker.tracking.track import Track, join_chunks, load_track
    from tracker.tracking.warm_up import warm_up

use_kernel_cache()

__getattr__, __dir__ = offer(__name__)
