"""Files of the desk."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, HTTPException, Query, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import FileResponse, Response

from ulna.serve.contract.files import FileInfo, FileKind, Files
from ulna.serve.desk import MOST_BYTES
from ulna.serve.routes.common import Digest, workshop

router = APIRouter(prefix="/files", tags=["files"])
BYTES = "application/octet-stream"


@router.get("")
def files(request: Request, kind: FileKind | None = None) -> Files:
    """All, or those of a kind; the newest first."""
    return Files(files=workshop(request).desk.all(*([] if kind is None else [kind])))


@router.post(
    "",
    openapi_extra={
        "requestBody": {"required": True, "content": {BYTES: {"schema": {"type": "string", "format": "binary"}}}}
    },
)
async def bring(request: Request, name: Annotated[str, Query(min_length=1, max_length=400)]) -> FileInfo:
    """A file, its bytes as the body. The same bytes are there once."""
    pieces, count = [], 0
    async for piece in request.stream():
        count += len(piece)
        if count > MOST_BYTES:
            raise HTTPException(413, f"{name[:80]}: more than {MOST_BYTES} bytes; expected fewer. Cut it.")
        pieces.append(piece)
    return await run_in_threadpool(workshop(request).desk.put, name, b"".join(pieces))


@router.get("/{sha256}")
def info(request: Request, sha256: Digest) -> FileInfo:
    """What is known of one."""
    return workshop(request).desk.info(sha256)


@router.get("/{sha256}/content", responses={200: {"content": {BYTES: {}}}}, response_class=Response)
def content(request: Request, sha256: Digest) -> FileResponse:
    """Its bytes, as they came; never shown by a browser, always saved."""
    desk = workshop(request).desk
    headers = {"etag": f'"{sha256}"', "cache-control": "private, max-age=31536000, immutable"}
    return FileResponse(desk.path(sha256), media_type=BYTES, filename=desk.info(sha256).name, headers=headers)


@router.get("/{sha256}/report", responses={200: {"content": {"text/html": {}}}}, response_class=Response)
def report(request: Request, sha256: Digest) -> Response:
    """A report in HTML, to be shown in a frame of its own origin: only what this program wrote."""
    workshop_ = workshop(request)
    path = workshop_.desk.path(sha256)
    if path.suffix != ".html" or workshop_.jobs_folder not in path.parents:
        raise HTTPException(404, f"{path.name}: no report that was made here. Make one.")
    return FileResponse(path, media_type="text/html; charset=utf-8")
