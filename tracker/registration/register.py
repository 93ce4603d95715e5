"""One scan from points to a judged registration."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Callable
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.scan import MAX_POINTS, Scan
from tracker.model.blend_limits import blend_limits
from tracker.model.blend_mirroring import mirror_blend
from tracker.model.blend_model import BlendModel
from tracker.registration.anatomy import make_anatomical_prior
from tracker.registration.free_fit import FreeFit, FreeSurface
from tracker.registration.hand_state import HandState
from tracker.registration.model_fit import Evaluation, ModelFit
from tracker.registration.options import RegistrationOptions
from tracker.registration.pose_prior import PosePrior
from tracker.registration.registration import Registration, RegistrationStart, digest_model, digest_scan
from tracker.registration.scan_points import ScanPoints, arrange_points, find_hand_points
from tracker.registration.start import StartSearch
from tracker.registration.verdict import judge, refuse
from tracker.registration.vertex_fit import fit_to_vertices

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], None]

SIZES = (0.06, 1.5)
"""m; box around the points of a hand, with forearm: beyond, the unit is wrong or there is no hand."""

MIN_POINTS = 50


@dataclass(frozen=True)
class Tools:
    """What registering needs of a model and works out once: thousands of scans share it."""

    model: BlendModel
    model_digest: str
    fit: ModelFit
    free: FreeFit
    starts: StartSearch


_tools: OrderedDict[tuple[int, int], tuple[BlendModel, PosePrior | None, Tools]] = OrderedDict()


def prepare_tools(model: BlendModel, prior: PosePrior | None = None) -> Tools:
    """Search tree, prior and elimination order of a model; the last few are kept."""
    key = (id(model), id(prior))
    if key not in _tools or _tools[key][0] is not model or _tools[key][1] is not prior:
        right = model if model.side == "right" else mirror_blend(model)
        limits = blend_limits(right)
        fit = ModelFit(right, prior or make_anatomical_prior(right, limits))
        tools = Tools(right, digest_model(right), fit, FreeFit(fit), StartSearch(fit, limits))
        _tools[key] = (model, prior, tools)
        while len(_tools) > 4:
            _tools.popitem(last=False)
    return _tools[key][2]


def register_scan(
    scan: Scan,
    model: BlendModel,
    options: RegistrationOptions | None = None,
    start: RegistrationStart | None = None,
    progress: Progress | None = None,
) -> Registration:
    """Lay the model's mesh onto a scan, [R17] section 3.2, and judge the result.

    Whatever the scan holds, there is a result: without a hand its verdict is "bad" and its reasons say why.

    Args:
        scan: In metres.
        model: Right or left; a left scan is registered in the mirror with the right model.
        options: How.
        start: Where to begin; found without help when left out.
        progress: Is told a stage and its share of the whole; what it raises ends the work.
    """
    options = options or RegistrationOptions()
    tell = progress or (lambda stage, share: None)
    began = time.perf_counter()
    clock = _Clock()
    with clock.measure("prepare"):
        tools = prepare_tools(model, options.prior)
        keep, notes = find_hand_points(scan, options.use_colors)
        fault = _find_fault(scan, keep)
        points = arrange_points(scan, keep, options.max_points) if fault is None else None
    if points is None or fault is not None:
        return refuse(scan, tools.model, tools.model_digest, (fault or "", *notes), time.perf_counter() - began)
    tell("start", 0.0)
    with clock.measure("start"):
        evaluation, side, scans = _begin(tools, points, options, start, tell)
    state = evaluation.state
    hand = scans[side]
    tell("model", 0.6)
    with clock.measure("model"):
        for count, settings in options.model_stages:
            evaluation = tools.fit.fit(state, hand.first(count), settings)
            state = evaluation.state
    tell("surface", 0.7)
    with clock.measure("surface"):
        surface = FreeSurface(
            evaluation.posed.vertices, state, evaluation.posed.vertices, evaluation.matches, evaluation.weights, 0.0
        )
        for number, (count, settings) in enumerate(options.free_stages):
            surface = tools.free.fit(surface, hand.first(count), settings)
            tell("surface", 0.7 + 0.2 * (number + 1) / len(options.free_stages))
        count, settings = options.last_stage
        centred = replace(surface.state, translation=surface.state.translation + surface.offset)
        last = tools.fit.fit(centred, hand.first(count), settings)
    with clock.measure("judge"):
        flip = np.array([1.0 if side == "right" else -1.0, 1.0, 1.0])
        distances = _measure(tools, surface.vertices, scan, keep, flip)
        verdict = judge(tools.fit, hand, evaluation, surface, distances, int(keep.sum()))
    tell("done", 1.0)
    return Registration(
        vertices=surface.vertices * flip,
        model_vertices=last.posed.vertices * flip,
        faces=np.asarray(tools.model.faces if side == "right" else tools.model.faces[:, ::-1], dtype=np.int64),
        pose=last.state.pose,
        shape=last.state.shape,
        translation=last.state.translation,
        side=side,
        verdict=verdict.name,
        score=verdict.score,
        reasons=(*verdict.reasons, *notes),
        scan_to_mesh=distances,
        seconds=time.perf_counter() - began,
        timings=clock.seconds,
        scan=scan.name,
        scan_digest=digest_scan(scan),
        model_digest=tools.model_digest,
        measures=verdict.measures,
    )


def _begin(
    tools: Tools, points: ScanPoints, options: RegistrationOptions, start: RegistrationStart | None, tell: Progress
) -> tuple[Evaluation, str, dict[str, ScanPoints]]:
    """A state to fit from, its side, and the points of either side."""
    if start is not None:
        scans = {start.side: points if start.side == "right" else points.mirrored()}
        shape = np.zeros(tools.model.num_shape)
        shape[: len(start.shape)] = start.shape[: len(shape)]
        state = HandState(np.array(start.pose, dtype=np.float64), shape, np.array(start.translation, dtype=np.float64))
        if start.vertices is not None:
            flip = np.array([1.0 if start.side == "right" else -1.0, 1.0, 1.0])
            state = fit_to_vertices(tools.fit, state, start.vertices * flip)
        count, settings = options.model_stages[0]
        return tools.fit.evaluate(state, scans[start.side].first(count), settings), start.side, scans
    sides = (options.side,) if options.side else ("right", "left")
    scans = {side: points if side == "right" else points.mirrored() for side in sides}
    found = tools.starts.find(scans, lambda share: tell("start", 0.6 * share))
    return found[0].evaluation, found[0].side, scans


def _find_fault(scan: Scan, keep: npt.NDArray[np.bool_]) -> str | None:
    """Why there is nothing to register, if so."""
    count = int(keep.sum())
    if count < MIN_POINTS:
        return f"{count} of {len(keep)} points may be a hand's; needed at least {MIN_POINTS}"
    low, high = np.percentile(scan.points[keep], [1.0, 99.0], axis=0)
    size = float(np.linalg.norm(high - low))
    if not SIZES[0] <= size <= SIZES[1]:
        return (
            f"the points are {size:.3g} m across, a hand {SIZES[0]:g} m to {SIZES[1]:g} m with its forearm: "
            "say the scan's unit (metres per unit)"
        )
    return None


def _measure(tools: Tools, vertices: Array, scan: Scan, keep: npt.NDArray[np.bool_], flip: Array) -> Array:
    """(N,) distance of every point to the surface, m; NaN for what is no part of the hand."""
    distances = np.full(len(scan.points), np.nan)
    ids = np.flatnonzero(keep)[:MAX_POINTS]
    points = np.ascontiguousarray(scan.points[ids] * flip)
    found = tools.fit.search.match(vertices, points, np.zeros_like(points), reach=10.0)
    distances[ids] = np.where(found.on_rim, np.nan, np.abs(found.offsets))
    return distances


class _Clock:
    """Processor seconds by stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def measure(self, stage: str):
        began = time.thread_time()
        yield
        self.seconds[stage] = self.seconds.get(stage, 0.0) + time.thread_time() - began
