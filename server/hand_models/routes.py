"""`/hand-skeleton`, `/hand-models`."""

from __future__ import annotations

from fastapi import APIRouter

from server.database.paging import Page
from server.errors import error_responses
from server.hand_models import service
from server.hand_models.schemas import HandModelOut, HandSkeleton
from tracker import HAND_EDGES, HAND_JOINTS

router = APIRouter(tags=["hands"], responses=error_responses())


@router.get("/hand-skeleton")
def get_hand_skeleton() -> HandSkeleton:
    """Joints of a hand and how they hang together."""
    fingers = dict.fromkeys(joint.split("_")[0] for joint in HAND_JOINTS if "_" in joint)
    return HandSkeleton(joints=list(HAND_JOINTS), edges=[(a, b) for a, b in HAND_EDGES], fingers=list(fingers))


@router.get("/hand-models")
def list_hand_models() -> Page[HandModelOut]:
    """Hand models that recordings can be tracked with."""
    return Page(items=list(service.list_hand_models()), next_cursor=None)
