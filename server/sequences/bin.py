"""Recordings in the bin."""

from __future__ import annotations

from server.bin.kinds import make_kind
from server.sequences.models import SequenceRow
from server.sequences.service import AREA

RECORDINGS = make_kind("recording", "recording", SequenceRow, AREA)
