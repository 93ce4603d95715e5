"""What a user may choose about a tracking run."""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from typing import Any

from tracker.errors import TrackingError
from tracker.model.max_faces import MAX_FACES

TERM_LABELS = {
    "LO": "images",
    "LO+C": "images, collision",
    "LO+S": "images, fingertips",
    "LO+SC": "images, fingertips, collision",
    "LO+P": "images, physics",
    "LO+CP": "images, collision, physics",
    "LO+SP": "images, fingertips, physics",
    "LO+SCP": "images, fingertips, collision, physics",
}
"""Sets of terms that can be asked for, in the paper's letters, and what they are made of, for people."""

TERMS = tuple(TERM_LABELS)

METHODS = ("handloom", "t16")
"""Our tracker, or Algorithm 1 of [T16] with no term and no step beyond it (docs/objective.md)."""


LAST_FRAME = 10_000_000
"""A bound of forms, beyond every recording."""


def _option(default: Any, help_text: str, **metadata: Any) -> Any:
    """A field with what forms and commands need to know.

    Args:
        default: Its value if nobody says otherwise.
        help_text: One line for people.
        metadata: `label`; `choices` and their `choice_labels`; `low` and `high` bound of a number; its `unit`;
            `is_advanced` for what few people ever set; `about`: "recording" (what to track), "machine", or else how.
    """
    return field(default=default, metadata={"help": help_text, **metadata})


@dataclass(frozen=True)
class TrackOptions:
    """Options of a run; every field has its default and one line of help, which forms and commands show.

    Raises:
        TrackingError: A value makes no sense; the message says which and what is allowed.
    """

    terms: str = _option(
        "LO+SC",
        "LO fits depth both ways; C collision, S fingertips, P physics.",
        label="Terms",
        choices=TERMS,
        choice_labels=tuple(f"{name} · {TERM_LABELS[name]}" for name in TERMS),
    )
    method: str = _option(
        "handloom",
        "Handloom's tracker, or the algorithm of T16 as the paper has it: full meshes, every match, no search.",
        label="Method",
        choices=METHODS,
        choice_labels=("Handloom", "T16, as written"),
        is_advanced=True,
    )
    iterations: int = _option(10, "Gauss-Newton iterations on every frame.", label="Iterations", low=1, high=200)
    first_iterations: int = _option(
        50,
        "Iterations on the first frame, which starts farther off.",
        label="Iterations on the first frame",
        low=1,
        high=500,
        is_advanced=True,
    )
    first_frame: int = _option(
        0, "First frame to track.", label="First frame", low=0, high=LAST_FRAME, about="recording"
    )
    last_frame: int = _option(
        -1,
        "Last frame to track; -1 is the recording's last.",
        label="Last frame",
        low=-1,
        high=LAST_FRAME,
        about="recording",
    )
    calibrate: bool = _option(True, "Fit the hand's size and shape to the first second.", label="Fit the hand's shape")
    use_skin: bool = _option(
        True, "Use skin colour to distinguish hands from other things, where there is colour.", label="Use skin colour"
    )
    use_detector: bool = _option(
        True,
        "Find the hands' joints in colour images by a neural network; depth alone decides where there is no colour.",
        label="Use the hand detector",
    )
    recover: bool = _option(True, "Look for a lost hand in the whole image.", label="Recover a lost hand")
    static_scene: str = _option(
        "find",
        "Tables and walls for physics: the recording's own, else the largest plane behind the hands in the depth.",
        label="Static scene",
        choices=("find", "recording", "none"),
        choice_labels=("Recording's, else found in depth", "Recording's only", "None"),
        is_advanced=True,
        about="recording",
    )
    stop_below_mm: float = _option(
        0.0,
        "Stop iterating when the mean joint moves less than this; 0: never.",
        label="Stop below",
        low=0.0,
        high=100.0,
        unit="mm",
        is_advanced=True,
    )
    camera: str = _option(
        "",
        "Depth camera to track in; empty: the first that has depth.",
        label="Camera",
        is_advanced=True,
        about="recording",
    )
    cameras: str = _option(
        "",
        "Cameras to track in together, ids separated by commas; empty takes the depth camera, without one all.",
        label="Several cameras",
        is_advanced=True,
        about="recording",
    )
    use_depth: bool = _option(
        True,
        "In several cameras: fit to the depth images of those that have some, too.",
        label="Depth in several cameras",
        is_advanced=True,
    )
    threads: int = _option(
        1,
        "Threads; with two, the next frame is read and looked at while this one is fitted.",
        label="Threads",
        low=1,
        high=64,
        is_advanced=True,
        about="machine",
    )

    def __post_init__(self) -> None:
        for option in fields(self):
            value = getattr(self, option.name)
            choices = option.metadata.get("choices", (value,))
            if value not in choices:
                raise TrackingError(f"{option.name} is {value!r}; needed one of {', '.join(choices)}.")
            if "low" not in option.metadata:
                continue
            low, high = option.metadata["low"], option.metadata["high"]
            if isinstance(value, bool) or not isinstance(value, int | float) or not low <= value <= high:
                raise TrackingError(f"{option.name} is {value!r}; needed a number from {low} to {high}.")
        if 0 <= self.last_frame < self.first_frame:
            raise TrackingError(f"The last frame, {self.last_frame}, comes before the first, {self.first_frame}.")

    @property
    def view_ids(self) -> tuple[str, ...]:
        """The cameras that were chosen to be tracked in together, by id; none where none were chosen."""
        return tuple(name for name in (part.strip() for part in self.cameras.split(",")) if name)

    @property
    def term_letters(self) -> str:
        """The letters behind LO."""
        return self.terms.partition("+")[2]

    @property
    def is_as_written(self) -> bool:
        """Whether the paper's algorithm runs, and not ours."""
        return self.method == "t16"

    @property
    def max_faces(self) -> int | None:
        """Meshes are decimated to at most this many faces when they are loaded; None keeps them, as the paper does."""
        return None if self.is_as_written else MAX_FACES

    def to_json(self) -> dict[str, Any]:
        """Plain values by name."""
        return asdict(self)

    @classmethod
    def from_json(cls, values: dict[str, Any]) -> TrackOptions:
        """Options from plain values; what is not given keeps its default."""
        known = {f.name: f for f in fields(cls)}
        kinds = {bool: "true or false", int: "a whole number", float: "a number", str: "a text"}
        for name, value in values.items():
            if name not in known:
                raise TrackingError(f"There is no option {name!r}; there are {', '.join(known)}.")
            wanted = type(known[name].default)
            allowed = (int, float) if wanted is float else (wanted,)
            if not isinstance(value, allowed) or (wanted is not bool and isinstance(value, bool)):
                raise TrackingError(f"{name} is {value!r}; needed {kinds[wanted]}.")
        return cls(**values)

    def frame_range(self, frame_count: int) -> range:
        """The frames to track of a recording of this length."""
        last = frame_count - 1 if self.last_frame < 0 else self.last_frame
        if self.first_frame > last or last >= frame_count:
            raise TrackingError(
                f"Frames {self.first_frame} to {last} were asked for; the recording has 0 to {frame_count - 1}."
            )
        return range(self.first_frame, last + 1)
