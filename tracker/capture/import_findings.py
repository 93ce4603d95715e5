"""What is found while a recording is looked at, before anything of it is stored."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any

from tracker.capture.import_question import ImportQuestion, make_question
from tracker.errors import say_count


@dataclass
class Findings:
    """Sentences for people, gathered in the order in which things are found.

    Attributes:
        problems: Reasons to refuse the recording.
        warnings: Oddities that refuse nothing.
        questions: What somebody has to tell or may tell.
    """

    problems: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)
    questions: list[ImportQuestion] = field(default_factory=list)

    def refuse(self, text: str, option: str = "", ask: str = "", **more: Any) -> None:
        """A reason to refuse and, where an option mends it, the question for that option."""
        self.problems.append(text)
        if option:
            self.questions.append(make_question(option, ask or text, text, **more))

    def warn(self, text: str) -> None:
        """An oddity."""
        self.warnings.append(text)

    def ask(self, option: str, text: str, **more: Any) -> None:
        """A question that may stay unanswered."""
        self.questions.append(make_question(option, text, **more))

    def miss(self, text: str, is_allowed: bool | None, *, allowed: str, refused: str, ask: str) -> None:
        """Frames are missing: an oddity where gaps are allowed, else a reason to refuse; each with its own ending."""
        if is_allowed:
            self.warn(f"{text} {allowed}")
        else:
            self.refuse(f"{text} {refused}", "allow_gaps", f"{text} {ask}")

    def leave_out(self, names: Collection[str], one: str = "other file is", several: str = "other files are") -> None:
        """Files that are not imported."""
        if names:
            self.warn(f"{say_count(len(names), one, several)} left out: {show_first(names, 3)}.")


def show_first(names: Collection[str], most: int, joint: str = ", ") -> str:
    """The first names, and how many more there are."""
    return joint.join([*list(names)[:most], *([f"and {len(names) - most} more"] if len(names) > most else [])])
