"""What the tracker offers to other programs."""

from __future__ import annotations

import subprocess
import sys
from importlib import import_module
from pathlib import Path
from pkgutil import iter_modules

import pytest

import tracker
from tracker.lazy_names import find_homes

FACES = ("", ".calibration", ".capture", ".detection", ".evaluation", ".inspection", ".label_formats", ".landmarks")
FACES = (*FACES, ".model", ".training")


def homes(face: str) -> dict[str, str]:
    return find_homes(Path(str(import_module(f"tracker{face}").__file__)))


@pytest.mark.parametrize("face", FACES)
def test_every_name_that_is_offered_can_be_loaded_and_is_listed(face: str) -> None:
    room = import_module(f"tracker{face}")
    for name, home in homes(face).items():
        assert getattr(room, name) is getattr(import_module(home), name), f"tracker{face}.{name}"
        assert name in dir(room)
    with pytest.raises(AttributeError, match="no attribute 'nothing'"):
        _ = room.nothing


@pytest.mark.parametrize("face", FACES)
def test_no_name_is_that_of_a_module_beside_it(face: str) -> None:
    room = import_module(f"tracker{face}")
    assert not {module.name for module in iter_modules(room.__path__)} & set(homes(face))


def test_the_tracker_itself_offers_sixty_names_at_most_and_no_room_offers_one_of_them_under_another_home() -> None:
    own = homes("")
    assert len(own) <= 60
    for face in FACES[1:]:
        assert {name: own[name] for name in homes(face) if name in own}.items() <= homes(face).items()


def test_importing_the_tracker_loads_none_of_its_rooms() -> None:
    code = "import sys, tracker; print(sorted(name for name in sys.modules if name.startswith('tracker.')))"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "['tracker.kernel_cache', 'tracker.lazy_names']"


def test_what_is_not_offered_is_refused() -> None:
    with pytest.raises(AttributeError, match="module 'tracker' has no attribute 'nothing'"):
        _ = tracker.nothing  # pyright: ignore[reportAttributeAccessIssue]
