"""The fits of a part of the scene to one frame: what they share."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tracker.fitting.attempt import MIN_PIXELS, Attempt, attempt_fit, look
from tracker.fitting.frame_fit import FitOptions
from tracker.fitting.objective import Objective
from tracker.fitting.region import is_outgrown, region_around
from tracker.fitting.setup import TrackSetup
from tracker.fitting.sighting import Sightings
from tracker.observation import Observation
from tracker.search.part import Part
from tracker.search.start_annotated import with_marks
from tracker.search.tools import Tools
from tracker.tracking.state import TrackState

Array = npt.NDArray[np.float64]

WIDER = 3
"""So often at most the region follows a fit that went beyond it."""


@dataclass(frozen=True)
class PartFits:
    """The fits of a part of the scene to one frame.

    Attributes:
        sightings: The frame, and what the hand detector sees in it.
        part: Of the scene.
        tools: Of the run.
        state: After the frame before.
    """

    sightings: Sightings
    part: Part
    tools: Tools
    state: TrackState

    @property
    def setup(self) -> TrackSetup:
        return self.part.setup

    @cached_property
    def previous(self) -> Array:
        """(d,) the part's pose in the frame before."""
        return self.part.take(self.state.pose)

    @property
    def is_first(self) -> bool:
        return self.state.next_frame == self.setup.options.first_frame

    @cached_property
    def options(self) -> FitOptions:
        """Of the first fit; where a detector looks, the second thread looks at the next frame meanwhile."""
        chosen = self.setup.options
        return FitOptions(
            iterations=chosen.first_iterations if self.is_first else chosen.iterations,
            stop_below=0.001 * chosen.stop_below_mm,
            threads=1 if self.sightings.is_looked_at else min(chosen.threads, 2),
        )

    def predict(self) -> Array:
        """(d,) where the part should be in this frame."""
        earlier = self.part.take(self.state.earlier_pose)
        return replace(self.state, pose=self.previous, earlier_pose=earlier).predict(self.setup.scene)

    def look(self, pose: Array, min_pixels: int = MIN_PIXELS) -> Observation | None:
        """What is seen around a pose (d,); None where too little is."""
        return look(self.sightings.frame, self.sightings.camera, self.setup, pose, min_pixels)

    def lead(self, objective: Objective) -> Objective:
        """The objective with the joints that the hand detector saw."""
        return self.sightings.add_to(objective, self.setup.scene, self.setup.names)

    def usual_objective(self, seen: Observation) -> Objective:
        """That of every frame."""
        return self.tools.objective if self.setup.own_detector is None else self.tools.with_fingertips(seen)

    def own_objective(self, objective: Objective) -> Objective:
        """That of this frame, from that of every frame: with joints in the first one and where a thing hides a hand."""
        if self.sightings.is_covered or self.is_first:
            objective = self.lead(objective)
        if not self.is_first:
            return objective
        setup = self.setup
        return with_marks(objective, setup.scene, setup.names, setup.marks, self.sightings.camera)

    def fit(self, seen: Observation, start: Array, objective: Objective, options: FitOptions) -> Attempt:
        """The fit from a pose (d,), and how good it is."""
        return attempt_fit(self.setup, seen, start, self.previous, objective, options, self.sightings)

    def look_wider(
        self, seen: Observation, best: Attempt, objective: Objective, options: FitOptions
    ) -> tuple[Observation, Attempt]:
        """What is seen around the pose that was found, and a fit to that, if it went so far that part was cut off."""
        camera = self.sightings.camera
        for _ in range(WIDER):
            needed = region_around(self.setup.scene.pose_at(best.pose).vertices, camera)
            if needed is None or not is_outgrown(seen.region, needed, camera):
                break
            wider = self.look(best.pose)
            if wider is None:
                break
            seen, best = wider, self.fit(wider, best.pose, objective, options)
        return seen, best
