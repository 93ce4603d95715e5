"""Go from frame to frame in colour views: find the hands in every image, fit, judge, and place what was lost again."""

from __future__ import annotations

from time import perf_counter

from tracker.capture.sequence import Sequence
from tracker.fitting.choose_views import PLENTY
from tracker.fitting.frame_fit import Fit
from tracker.fitting.setup import TrackSetup
from tracker.fitting.view_hands import ViewHands
from tracker.model.scene import PosedScene
from tracker.search.part import Part
from tracker.search.place_in_views import place_in_views
from tracker.search.tools import Tools
from tracker.tracking.ahead import ViewsAhead, ViewsRead
from tracker.tracking.fit_views import fit_views, judge_hand
from tracker.tracking.frame_result import FrameResult, sum_up, tell_statuses
from tracker.tracking.see_hands import see_hands
from tracker.tracking.state import TrackState
from tracker.tracking.view_objects import judge_objects
from tracker.tracking.watch_objects import stop_unseen


def follow_views(
    sequence: Sequence, setup: TrackSetup, tools: Tools, state: TrackState, ahead: ViewsAhead | None = None
) -> tuple[TrackState, FrameResult, ViewHands]:
    """Track the next frame in the views of a run; also what was seen in it.

    Args:
        sequence: The recording.
        setup: Models and options.
        tools: Of the run.
        state: After the frame before.
        ahead: Reads the images of the frame after this one meanwhile. The seconds of a frame are then those of the
            clock, with what it had to wait for its images.
    """
    started = perf_counter()
    if ahead:
        read = ahead.take(state.next_frame)
    else:
        read = ViewsRead.of(sequence, setup, state.next_frame, setup.options.threads)
        started = perf_counter()
    looked_at, views = perf_counter(), read.views
    scene, hands, gone = setup.scene, setup.hands, set(state.gone_hands(setup))
    pose = state.predict(scene, bends=len(views) >= PLENTY)
    seen = see_hands(setup, views, scene.pose_at(pose), gone)
    stages = {"reading": read.seconds, "detecting hands": perf_counter() - looked_at}
    if ahead:
        ahead.begin(state.next_frame + 1)  # not before: the detector takes all threads
    placed = {hand: place_in_views(setup.models[hand], setup.names[hand], seen) for hand in sorted(gone)}
    found = {hand for hand, own in placed.items() if own is not None}
    for hand in found:
        pose[scene.pose_slices[hand]] = placed[hand]
    iterations = setup.options.first_iterations if found else setup.options.iterations
    part = Part.without(setup, tuple(gone - found))  # what is lost is nowhere: it hides and touches nothing
    fit = Fit(part.take(pose), (), {})
    if part.kept:
        started_nails = perf_counter()
        objective = tools.with_nails(part.setup.scene.pose_at(fit.pose), views, setup.options.threads)
        stages |= {"finding nails": perf_counter() - started_nails} if tools.nail_detector else {}
        followed = {hand: setup.names[hand] for hand in hands if hand not in gone}
        believed = seen.without_jumps(scene.pose_at(pose), followed, sequence.fps)
        fit = fit_views(part.setup, objective, believed, views, fit.pose, iterations)
    pose = part.put(fit.pose, pose)
    posed = scene.pose_at(pose)
    lost, left = _judge_hands(setup, seen, posed, gone, found)
    earlier = state.pose.copy()
    for hand in gone | left:
        where = scene.pose_slices[hand]
        if hand in left:
            pose[where] = state.pose[where]
        earlier[where] = pose[where]
    statuses = tell_statuses(hands, lost, found)
    objects = judge_objects(part.setup, views, part.setup.scene.pose_at(fit.pose)) if part.kept else []
    result = FrameResult(
        state.next_frame,
        pose,
        sum_up(statuses),
        perf_counter() - started,
        None,
        fit.costs,
        fit.stages | stages,
        tuple(objects),
        hand_status=statuses,
        seen=seen.stack(setup.hand_names, setup.view_ids),
    )
    earlier = stop_unseen(setup, pose, earlier, objects)
    after = TrackState(state.next_frame + 1, pose, earlier, is_lost=bool(left), lost_hands=tuple(sorted(left)))
    return after, result, seen


def _judge_hands(
    setup: TrackSetup, seen: ViewHands, posed: PosedScene, gone: set[int], found: set[int]
) -> tuple[set[int], set[int]]:
    """Hands that are lost now, and those of them that stay where they were instead of being followed.

    Args:
        setup: Models and options.
        seen: The hands in all views.
        posed: As it was fitted.
        gone: Hands that were lost before this frame.
        found: Those of them that were placed anew.
    """
    verdicts = {hand: judge_hand(setup, seen, posed, hand) for hand in setup.hands}
    lost = {hand for hand, (is_held, _) in verdicts.items() if hand in gone - found or not is_held}
    return lost, {hand for hand in lost if hand in gone or not verdicts[hand][1]}
