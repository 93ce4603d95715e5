"""What the terms of a run need besides the frame: detectors of fingertips or nails, and the physics world."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tracker.capture.frame import CameraFrame
from tracker.detection import Forest, find_fingertips
from tracker.fitting.objective import Objective
from tracker.fitting.setup import TrackSetup
from tracker.model.scene import PosedScene
from tracker.observation import Observation
from tracker.physics import PhysicsWorld
from tracker.search.find_nails import find_nails_in_views
from tracker.terms.collision import Collision
from tracker.terms.salient import Salient


@dataclass(frozen=True)
class Tools:
    """Heavy helpers of a run, made once.

    Attributes:
        objective: Terms that need nothing but the frame.
        detector: Finds fingertips, or None where the run has no salient points.
        world: Simulates, or None where the run has no physics or no object.
        nail_detector: Finds finger nails in colour views, or None where nobody gave one.
    """

    objective: Objective
    detector: Forest | None
    world: PhysicsWorld | None
    nail_detector: Forest | None = None

    def with_fingertips(self, seen: Observation) -> Objective:
        """The objective with the frame's fingertip detections, [T16] §3.2.5.

        Differs from the paper, which has them in every frame: those of the bundled detector are asked for
        where a fit went badly, which is what they are for; a lab's own is asked in every frame. A hand that is followed
        well gains nothing from them and loses time, and where an object hides fingertips a false detection pulls
        (docs/journal.md).
        """
        if self.detector is None:
            return self.objective
        detections = find_fingertips(self.detector, seen)
        return replace(self.objective, terms={**self.objective.terms, "salient": Salient(detections)})

    def with_nails(self, posed: PosedScene, views: Sequence[CameraFrame], threads: int) -> Objective:
        """The objective with the nails that views show, [T16] §3.3, looked for around a posed scene."""
        if self.nail_detector is None:
            return self.objective
        nails = find_nails_in_views(self.nail_detector, posed, views, threads)
        return replace(self.objective, terms={**self.objective.terms, "nails": nails})


@contextmanager
def make_tools(setup: TrackSetup, T_world_camera: npt.NDArray[np.float64]) -> Iterator[Tools]:
    """The helpers that the run's terms ask for, closed at the end."""
    letters = setup.options.term_letters
    # In colour views each frame brings its own terms.
    terms = {} if setup.view_ids else dict(Objective().terms)
    if "C" in letters:
        terms["collision"] = Collision()
    detector = setup.fingertip_detector if "S" in letters and not setup.view_ids else None
    has_physics = "P" in letters and bool(setup.objects)
    with setup.make_world(T_world_camera) if has_physics else nullcontext() as world:
        yield Tools(Objective(terms=terms), detector, world, setup.nail_detector if "S" in letters else None)
