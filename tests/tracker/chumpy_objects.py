"""Objects whose pickles look like chumpy's, which cannot be installed."""

from __future__ import annotations

import contextlib
import sys
import types


class Ch:
    """What a pickle of chumpy's constant looks like: a dictionary with the array at "x"."""

    def __init__(self, x):
        self.x = x


class Select:
    """What a pickle of chumpy's selection looks like."""

    def __init__(self, a, idxs, preferred_shape):
        self.a, self.idxs, self.preferred_shape = a, idxs, preferred_shape


@contextlib.contextmanager
def chumpy_installed():
    """Modules of chumpy's names, for as long as a file is written."""
    Ch.__module__, Select.__module__ = "chumpy.ch", "chumpy.reordering"
    made = {"chumpy": {}, "chumpy.ch": {"Ch": Ch}, "chumpy.reordering": {"Select": Select}}
    for name, parts in made.items():
        sys.modules[name] = types.ModuleType(name)
        vars(sys.modules[name]).update(parts)
    try:
        yield
    finally:
        for name in made:
            del sys.modules[name]
