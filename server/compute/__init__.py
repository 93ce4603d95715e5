"""What takes long to compute, in a process of its own beside the studio."""

from server.compute.compute import Compute, ComputeDep
from server.compute.context import ComputeContext

__all__ = ["Compute", "ComputeContext", "ComputeDep"]
