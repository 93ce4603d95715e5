"""One scan from points to a judged registration."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt
from scipy.spatial.transform import Rotation

from tracker.capture.scan import MAX_POINTS, Scan
from tracker.capture.scan_size import SIZES_NEEDED, find_size_fault, measure_size
from tracker.model.blend_limits import blend_limits
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.free_fit import FreeFit, FreeSurface
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import Evaluation, ModelFit
from tracker.registration.options import RegistrationOptions
from tracker.registration.pose_prior import PosePrior
from tracker.registration.registration import VERDICTS, Registration, RegistrationStart, digest_model, digest_scan
from tracker.registration.scan_frame import ScanFrame, find_scan_frame
from tracker.registration.scan_points import ScanPoints, arrange_points, find_hand_points
from tracker.registration.stage_clock import StageClock
from tracker.registration.start import StartSearch, find_apart
from tracker.registration.verdict import Verdict, judge, refuse
from tracker.registration.vertex_fit import fit_to_vertices

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

MIN_POINTS = 50
"""Fewer points are refused. Chosen, not measured."""

NEARLY, MOST_AGAIN = 1.03, 3
"""When a registration is not good: how many further starts are fitted, and their highest cost relative to the best."""


_TURN = Rotation.from_rotvec([0.5, -0.7, 0.4]).as_matrix()
_MIRROR = np.diag([-1.0, 1.0, 1.0])
TURNS = {"right": ScanFrame(_TURN, np.zeros(3)), "left": ScanFrame(_MIRROR @ _TURN @ _MIRROR, np.zeros(3))}
"""How the second look sees the scan of each side: turned away from the axes, a left hand's mirror image likewise."""


@dataclass(frozen=True)
class _Settled:
    """A surface (V, 3) of a right hand, the model that was fitted beside it, and what it is worth."""

    side: str
    vertices: Array
    model: Evaluation
    distances: Array
    verdict: Verdict


class Registrar:
    """Registers scans with one model; what depends on the model alone is computed once.

    Args:
        model: Right or left; a left scan is registered in the mirror with the right model.
        prior: Of the pose; the anatomical one when left out.

    Attributes:
        model: The right hand.
        model_digest: Names it in registrations.
        fit: Fits it to points.
        free: Fits a free surface coupled to it.
        starts: Looks for it in a scan.
    """

    def __init__(self, model: BlendModel, prior: PosePrior | None = None) -> None:
        self.model = model if model.side == "right" else mirror_blend(model)
        self.model_digest = digest_model(self.model)
        limits = blend_limits(self.model)
        self.fit = ModelFit(self.model, prior or make_anatomical_prior(self.model, limits))
        self.free = FreeFit(self.fit)
        self.starts = StartSearch(self.fit, limits)

    def register(
        self,
        scan: Scan,
        options: RegistrationOptions | None = None,
        start: RegistrationStart | None = None,
        progress: Progress | None = None,
    ) -> Registration:
        """Lay the model's mesh onto a scan, [R17] section 3.2, and judge the result.

        Whatever the scan holds, there is a result: without a hand its verdict is "bad" and its reasons say why.

        Args:
            scan: In metres.
            options: How.
            start: Where to begin; found without help when left out.
            progress: Is told a stage and its share of the whole; what it raises ends the work.
        """
        options = options or RegistrationOptions()
        tell = progress or (lambda stage, share: None)
        began = time.perf_counter()
        clock = StageClock(time.thread_time)
        with clock.measure("prepare"):
            keep, notes = find_hand_points(scan, options.use_colors)
            fault = _find_fault(scan, keep)
            points = arrange_points(scan, keep, options.max_points) if fault is None else None
        if points is None or fault is not None:
            return refuse(scan, self.model, self.model_digest, (fault or "", *notes), time.perf_counter() - began)
        frame = find_scan_frame(points.points)
        points, inside = frame.enter_points(points), frame.enter_scan(scan)
        tell("start", 0.0)
        with clock.measure("start"):
            evaluation, side, scans = self._begin(points, options, self._enter(frame, start), tell)
        tell("model", 0.6)
        best = self._settle(evaluation, side, scans[side], inside, keep, options, clock)
        if start is None and best.verdict.name != "good":
            tell("second look", 0.8)
            for side, evaluation in self._look_again(scans, clock):
                other = self._settle(evaluation, side, scans[side], inside, keep, options, clock)
                best = min(best, other, key=_misfit)
        tell("done", 1.0)
        flip = _flip(best.side)
        state = frame.leave_state(self.model, best.model.state, best.side)
        faces = self.model.faces if best.side == "right" else self.model.faces[:, ::-1]
        return Registration(
            vertices=frame.leave(best.vertices * flip),
            model_vertices=frame.leave(best.model.posed.vertices * flip),
            faces=np.asarray(faces, dtype=np.int64),
            pose=state.pose,
            shape=state.shape,
            translation=state.translation,
            side=best.side,
            verdict=best.verdict.name,
            score=best.verdict.score,
            reasons=(*best.verdict.reasons, *notes),
            scan_to_mesh=best.distances,
            seconds=time.perf_counter() - began,
            timings=clock.seconds,
            scan=scan.name,
            scan_digest=digest_scan(scan),
            model_digest=self.model_digest,
            measures=best.verdict.measures,
        )

    def _settle(
        self,
        evaluation: Evaluation,
        side: str,
        hand: ScanPoints,
        scan: Scan,
        keep: npt.NDArray[np.bool_],
        options: RegistrationOptions,
        clock: StageClock,
    ) -> _Settled:
        """From a start to a judged surface."""
        state = evaluation.state
        with clock.measure("model"):
            for count, settings in options.model_stages:
                evaluation = self.fit.fit(state, hand.first(count), settings)
                state = evaluation.state
        with clock.measure("surface"):
            surface = FreeSurface(
                evaluation.posed.vertices, state, evaluation.posed.vertices, evaluation.matches, evaluation.weights, 0.0
            )
            for count, settings in options.free_stages:
                surface = self.free.fit(surface, hand.first(count), settings)
            count, settings = options.last_stage
            centred = replace(surface.state, translation=surface.state.translation + surface.offset)
            last = self.fit.fit(centred, hand.first(count), settings)
        with clock.measure("judge"):
            distances = self._measure(surface.vertices, scan, keep, _flip(side))
            verdict = judge(self.fit, hand, evaluation, surface, distances, int(keep.sum()))
        return _Settled(side, surface.vertices, last, distances, verdict)

    def _look_again(self, scans: dict[str, ScanPoints], clock: StageClock) -> list[tuple[str, Evaluation]]:
        """Side and state of starts about as good as the best of a thorough search, each another arrangement.

        The search looks into grids along the axes. It looks at the scan turned, so that what the first look missed
        because of how its grids lay is not missed again.
        """
        with clock.measure("start"):
            turned = {side: TURNS[side].enter_points(points) for side, points in scans.items()}
            found = self.starts.find(turned, is_thorough=True)
            nearly = [start for start in find_apart(found) if start.cost <= NEARLY * found[0].cost][:MOST_AGAIN]
            count, settings = RegistrationOptions().model_stages[0]
            states = [
                (one.side, TURNS[one.side].leave_state(self.model, one.evaluation.state, "right")) for one in nearly
            ]
            return [(side, self.fit.evaluate(state, scans[side].first(count), settings)) for side, state in states]

    def _enter(self, frame: ScanFrame, start: RegistrationStart | None) -> RegistrationStart | None:
        """A start with the model's shape, brought into the frame in which the scan is registered."""
        if start is None:
            return None
        shape = np.zeros(self.model.num_shape)
        shape[: len(start.shape)] = start.shape[: len(shape)]
        state = HandState(np.array(start.pose, dtype=np.float64), shape, np.array(start.translation, dtype=np.float64))
        state = frame.enter_state(self.model, state, start.side)
        vertices = None if start.vertices is None else frame.enter(start.vertices)
        return RegistrationStart(start.side, state.pose, state.translation, state.shape, vertices)

    def _begin(
        self, points: ScanPoints, options: RegistrationOptions, start: RegistrationStart | None, tell: Progress
    ) -> tuple[Evaluation, str, dict[str, ScanPoints]]:
        """A state to fit from, its side, and the points of either side."""
        if start is not None:
            scans = {start.side: points if start.side == "right" else points.mirrored()}
            state = HandState(start.pose, start.shape, start.translation)
            if start.vertices is not None:
                state = fit_to_vertices(self.fit, state, start.vertices * _flip(start.side))
            count, settings = options.model_stages[0]
            return self.fit.evaluate(state, scans[start.side].first(count), settings), start.side, scans
        sides = (options.side,) if options.side else ("right", "left")
        scans = {side: points if side == "right" else points.mirrored() for side in sides}
        found = self.starts.find(scans, lambda share: tell("start", 0.6 * share))
        return found[0].evaluation, found[0].side, scans

    def _measure(self, vertices: Array, scan: Scan, keep: npt.NDArray[np.bool_], flip: Array) -> Array:
        """(N,) distance of every point to the surface, m; NaN for points that are not part of the hand."""
        distances = np.full(len(scan.points), np.nan)
        ids = np.flatnonzero(keep)[:MAX_POINTS]
        points = np.ascontiguousarray(scan.points[ids] * flip)
        found = self.fit.search.match(vertices, points, np.zeros_like(points), reach=10.0)
        distances[ids] = np.where(found.on_rim, np.nan, np.abs(found.offsets))
        return distances


def _misfit(settled: _Settled) -> tuple[int, float]:
    """Least for the best of several surfaces: the best verdict, then what misses the scan least and is strained least.

    Of hands folded otherwise, the wrong one's surface both misses the scan more and is strained more.
    """
    measures = settled.verdict.measures
    return VERDICTS.index(settled.verdict.name), measures["scan_to_surface"] * measures["stretch"]


def _flip(side: str) -> Array:
    return np.array([1.0 if side == "right" else -1.0, 1.0, 1.0])


def _find_fault(scan: Scan, keep: npt.NDArray[np.bool_]) -> str | None:
    """Why there is nothing to register, if so."""
    count = int(keep.sum())
    if count < MIN_POINTS:
        return f"{count} of {len(keep)} points may be a hand's; needed at least {MIN_POINTS}"
    if fault := find_size_fault(float(measure_size(scan.points[keep])[0])):
        return f"the scan {fault}; needed {SIZES_NEEDED}: give its unit (metres per unit), or crop what is not a hand"
    return None
