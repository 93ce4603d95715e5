"""A package offers what its TYPE_CHECKING block imports, and loads it when it is asked for."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from tracker.lazy_names import find_homes

INIT = '''"""A room."""

from typing import TYPE_CHECKING

from tracker.lazy_names import offer

if TYPE_CHECKING:
    from garden.beds import Bed, plant
    from garden.tools import Spade

__getattr__, __dir__ = offer(__name__)
'''


@pytest.fixture
def garden(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A package on disk whose modules say when they are loaded."""
    folder = tmp_path / "garden"
    folder.mkdir()
    (folder / "__init__.py").write_text(INIT)
    (folder / "beds.py").write_text("class Bed: ...\n\ndef plant(): return 'planted'\n")
    (folder / "tools.py").write_text("class Spade: ...\n")
    monkeypatch.syspath_prepend(tmp_path)
    import garden  # pyright: ignore[reportMissingImports]

    yield garden
    for name in [name for name in sys.modules if name.split(".")[0] == "garden"]:
        del sys.modules[name]


def test_a_module_is_loaded_when_the_first_of_its_names_is_asked_for_and_no_other(garden) -> None:
    assert not {"garden.beds", "garden.tools"} & set(sys.modules)
    assert garden.plant() == "planted"
    assert "garden.beds" in sys.modules and "garden.tools" not in sys.modules


def test_a_name_that_was_asked_for_is_kept_and_not_looked_for_again(garden) -> None:
    assert "Bed" not in vars(garden)
    bed = garden.Bed
    assert vars(garden)["Bed"] is bed and bed is sys.modules["garden.beds"].Bed


def test_all_names_are_listed_in_order_before_any_is_loaded(garden) -> None:
    listed = dir(garden)
    assert {"Bed", "Spade", "plant", "__name__"} <= set(listed) and listed == sorted(listed)
    assert "garden.tools" not in sys.modules


def test_a_name_that_nobody_offers_is_refused_with_the_package(garden) -> None:
    with pytest.raises(AttributeError, match="module 'garden' has no attribute 'rake'"):
        _ = garden.rake
    assert not hasattr(garden, "Bench")


def test_names_go_to_the_modules_that_they_are_imported_from_under_their_own_name(tmp_path: Path) -> None:
    path = tmp_path / "room.py"
    block = "if TYPE_CHECKING:\n    import sys\n    from b.c import One, two\n    from d import X\n"
    path.write_text(f"import os\nfrom a import Outside\n{block}")
    assert find_homes(path) == {"One": "b.c", "two": "b.c", "X": "d"}


@pytest.mark.parametrize("text", ["", "from a import B\n", "if True:\n    x = 1\n"])
def test_a_file_without_such_imports_offers_nothing(text: str, tmp_path: Path) -> None:
    (tmp_path / "room.py").write_text(text)
    assert find_homes(tmp_path / "room.py") == {}
