"""A real OpenID provider, `openid.mjs`, and somebody at it."""

from __future__ import annotations

import re
import shutil
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from urllib.parse import urljoin

import httpx
from tests.conftest import ROOT
from tests.real_parts import lacking
from tests.serve.laboratories import Laboratory

from ulna.serve.laboratory.provider import BACK

SECRET = "a secret of the client, for tests"


def free_port() -> int:
    with socket.socket() as made:
        made.bind(("127.0.0.1", 0))
        return int(made.getsockname()[1])


def stated(folder: Path, port: int, more: str = "") -> str:
    """What a laboratory's file says of it."""
    (folder / "secret").write_text(f"{SECRET}\n", encoding="utf-8")
    return (
        f'[provider]\nissuer = "http://127.0.0.1:{port}"\nclient_id = "ulna"\nsecret_file = "secret"\n'
        f'title = "the house\'s login"\n{more}\n'
    )


@contextmanager
def provider(laboratory: Laboratory, port: int) -> Iterator[None]:
    """One that knows a laboratory as its client."""
    node = shutil.which("node")
    if node is None or not (ROOT / "page" / "node_modules" / "oidc-provider").is_dir():
        lacking("Node with the page's packages (make page)")
    script = Path(__file__).with_name("openid.mjs")
    command = [node, str(script), str(port), f"{laboratory.address}{BACK}", SECRET]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    try:
        assert running.stdout is not None
        heard = ""
        while "listening" not in (line := running.stdout.readline()):
            heard += line
            assert line, heard
        yield
    finally:
        running.terminate()
        running.wait(10)
        assert running.stdout is not None
        running.stdout.close()


def browse(client: httpx.Client, url: str, login: str, own: str) -> httpx.Response:
    """What a browser gets that begins at `url` and signs in at the provider as `login`: the answer of the laboratory
    (`own`) to which it is sent back. Forms are filled in as the provider shows them."""
    answer = client.get(url, headers=_navigating())
    for _ in range(20):  # more ways than any provider needs
        if answer.is_redirect:
            target = urljoin(str(answer.url), answer.headers["location"])
            if target.startswith(f"{own}{BACK}"):
                return client.get(target, headers=_navigating())
            answer = client.get(target, headers=_navigating())
            continue
        action = re.search(r'<form[^>]*action="([^"]+)"', answer.text)
        assert action is not None, answer.text
        fields = dict(re.findall(r'<input[^>]*type="hidden"[^>]*name="(\w+)"[^>]*value="([^"]*)"', answer.text))
        fields |= {"login": login, "password": "x"} if 'name="login"' in answer.text else {}
        answer = client.post(urljoin(str(answer.url), action[1]), data=fields, headers=_navigating())
    raise AssertionError(answer.text)


def _navigating() -> dict[str, str]:
    return {"Accept": "text/html"}
