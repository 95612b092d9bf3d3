"""The application: routes, what guards them, and the contract of both."""

from __future__ import annotations

import hashlib
import json
from typing import Any

from fastapi import APIRouter, FastAPI
from pydantic import TypeAdapter

from ulna.ground.version import VERSION
from ulna.serve import page, problems
from ulna.serve.contract.live import LiveEvent
from ulna.serve.entrance import Entrance
from ulna.serve.guarding import Guard, Reach
from ulna.serve.guests import Guests
from ulna.serve.rights import PREFIX
from ulna.serve.routes import (
    about,
    activities,
    arms,
    bench,
    compare,
    files,
    filing,
    guided,
    jobs,
    live,
    outcomes,
    people,
    plans,
    proposals,
    provider,
    records,
    results,
    sources,
    tables,
)
from ulna.serve.routes.common import PROBLEMS
from ulna.serve.workshop import Workshop

ROUTERS: tuple[APIRouter, ...] = (
    about.router,
    bench.router,
    files.router,
    arms.router,
    sources.router,
    tables.router,
    plans.router,
    guided.router,
    activities.router,
    jobs.router,
    results.router,
    compare.router,
    outcomes.router,
    records.router,
    filing.router,
    proposals.router,
    people.router,
    provider.router,
)


def api() -> FastAPI:
    """Routes alone, without a bench: what the schema is made of."""
    app = FastAPI(
        title="Ulna workbench",
        version=VERSION,
        openapi_url=f"{PREFIX}/openapi.json",
        docs_url=None,
        redoc_url=None,
        separate_input_output_schemas=False,
    )
    for router in ROUTERS:
        app.include_router(router, prefix=PREFIX, responses=PROBLEMS)
    app.include_router(live.router, prefix=PREFIX)
    problems.install(app)
    document = app.openapi()
    _with_events(document)
    app.openapi = lambda: document  # type: ignore[method-assign]
    app.state.contract = contract(document)
    return app


def contract(document: dict[str, Any]) -> str:
    """What page and server must agree on: SHA-256 of the schema without its version."""
    same = {**document, "info": {}}
    return hashlib.sha256(json.dumps(same, sort_keys=True).encode()).hexdigest()


def make_app(workshop: Workshop, guests: Guests, entrance: Entrance, reach: Reach) -> Guard:
    """All of it, for one bench."""
    app = api()
    app.state.workshop, app.state.guests, app.state.entrance = workshop, guests, entrance
    page.install(app)
    return Guard(app, guests, entrance, reach)


def _with_events(document: dict[str, Any]) -> None:
    """Live events stand beside the models of requests, though no path of OpenAPI has them."""
    schema = TypeAdapter(LiveEvent).json_schema(mode="serialization", ref_template="#/components/schemas/{model}")
    known = document["components"]["schemas"]
    for name, one in schema.pop("$defs", {}).items():
        known.setdefault(name, one)
    known["LiveEvent"] = schema
