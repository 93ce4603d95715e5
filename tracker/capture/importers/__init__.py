"""One module for each kind of recording that can be imported, named after its format; all are found automatically."""

from __future__ import annotations

import inspect
from functools import cache
from importlib import import_module
from pkgutil import iter_modules
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tracker.capture.import_plan import Importer

IMPORT_FORMATS: tuple[str, ...] = tuple(module.name for module in iter_modules(__path__))


@cache
def list_importers() -> tuple[Importer, ...]:
    """One of each, in the order in which a folder is offered to them."""
    return tuple(sorted(map(_load, IMPORT_FORMATS), key=lambda importer: (importer.turn, importer.format)))


def _load(name: str) -> Importer:
    """The importer of a module: its only class that has the module's name as `format`."""
    module = import_module(f"{__name__}.{name}")
    classes: list[Any] = [one for _, one in inspect.getmembers(module, inspect.isclass)]
    [found] = [one for one in classes if getattr(one, "format", None) == name]
    return found()
