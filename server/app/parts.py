"""The parts of the app. A new package adds its router here, and what it starts and stops with the app."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractAsyncContextManager

from fastapi import APIRouter, FastAPI

from server.access import login_routes, people_routes, token_routes
from server.access import routes as accounts
from server.annotations import routes as annotations
from server.annotations.service import find_annotated_frames
from server.app import health
from server.bin import routes as bin_routes
from server.bodies import routes as bodies
from server.calibrations import board_routes
from server.calibrations import routes as calibrations
from server.calibrations.lifespan import clean_films
from server.detectors import routes as detectors
from server.evaluations import routes as evaluations
from server.exchange import routes as exchange
from server.exchange import snapshot_routes
from server.hand_models import routes as hand_models
from server.imports import routes as imports
from server.imports.lifespan import clean_imports
from server.jobs import old_routes as old_jobs
from server.jobs import routes as jobs
from server.lineage import routes as lineage
from server.live import routes as live
from server.moving_scans import body_set_routes as body_sets
from server.moving_scans import registration_routes as moving_registrations
from server.moving_scans import routes as moving_scans
from server.quality import queue_routes as quality_queue
from server.quality import routes as quality
from server.refinements import routes as refinements
from server.registrations import decision_routes as decisions
from server.registrations import model_routes
from server.registrations import routes as registrations
from server.registrations import training_set_routes as training_sets
from server.registrations.service import find_newest, settle_current
from server.scans import routes as scans
from server.scans.summaries import Resized
from server.scans.summaries import SummaryFinder as ScanSummaryFinder
from server.sequences import frame_routes
from server.sequences import routes as sequences
from server.sequences.summaries import SummaryFinder
from server.suggestions import routes as suggestions
from server.suggestions import triangulation_routes
from server.teams import routes as teams
from server.tracks import routes as tracks
from server.tracks.best_tracks import find_best_tracks
from server.viewer import routes as viewer

Lifespan = Callable[[FastAPI], AbstractAsyncContextManager[None]]

ROUTERS: tuple[APIRouter, ...] = (
    annotations.router,
    health.router,
    accounts.router,
    login_routes.router,
    token_routes.router,
    people_routes.router,
    hand_models.router,
    detectors.router,
    board_routes.router,
    calibrations.router,
    sequences.router,
    frame_routes.router,
    imports.router,
    jobs.router,
    old_jobs.router,
    tracks.router,
    viewer.router,
    evaluations.router,
    triangulation_routes.router,
    suggestions.router,
    refinements.router,
    quality.router,
    quality_queue.router,
    *teams.ROUTERS,
    live.router,
    exchange.router,
    snapshot_routes.router,
    scans.router,
    registrations.router,
    model_routes.router,
    decisions.router,
    training_sets.router,
    lineage.router,
    bodies.router,
    moving_scans.router,
    moving_registrations.router,
    body_sets.router,
    bin_routes.router,
)
"""All under `/api/v1`, looked through in this order at each request: what is asked most stands first."""

PAGE_ROUTERS: tuple[APIRouter, ...] = (viewer.page_router,)
"""Those with addresses of their own, such as the viewer's page."""

LIFESPANS: tuple[Lifespan, ...] = (clean_imports, clean_films, viewer.lifespan)
"""Entered in this order when the app starts (database and storage are there), left in reverse when it stops."""

SEQUENCE_SUMMARIES: tuple[SummaryFinder, ...] = (find_annotated_frames, find_best_tracks)
"""What rooms above the recordings know of them."""

SCAN_SUMMARIES: tuple[ScanSummaryFinder, ...] = (find_newest,)
"""What rooms above the scans know of them."""

SCAN_RESIZED: tuple[Resized, ...] = (settle_current,)
"""What rooms above the scans do when the size of one was corrected."""
