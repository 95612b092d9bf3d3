"""The laboratory's server as its guide sets it up: the files of docs/laboratory, a real nginx before it."""

from __future__ import annotations

import configparser
import json
import os
import shlex
import shutil
import ssl
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx
import pytest
from tests.cli_runs import run
from tests.conftest import ROOT
from tests.real_parts import lacking
from tests.serve.laboratories import Laboratory, certificate_in, laboratory, password_of, people_in
from tests.serve.openid import free_port
from tests.serve.servers import Client, wait_for

GUIDE = ROOT / "docs" / "laboratory"
NAMED = "arms.lab.example"


@contextmanager
def nginx(folder: Path, port: int, behind: int) -> Iterator[None]:
    """With the guide's own file, at other ports."""
    program = shutil.which("nginx") or shutil.which("/usr/sbin/nginx")
    if program is None:
        lacking("nginx")
    certificate, key = certificate_in(folder)
    site = (GUIDE / "nginx.conf").read_text(encoding="utf-8")
    for here, there in {
        "listen 443 ssl http2": f"listen 127.0.0.1:{port} ssl http2",
        "listen 80;": f"listen 127.0.0.1:{free_port()};",
        "127.0.0.1:8443": f"127.0.0.1:{behind}",
        f"/etc/ssl/{NAMED}.pem": str(certificate),
        f"/etc/ssl/private/{NAMED}.key": str(key),
    }.items():
        assert here in site
        site = site.replace(here, there)
    (folder / "site.conf").write_text(site, encoding="utf-8")
    temporary = "".join(
        f"{each}_temp_path {folder}/{each};\n" for each in ("client_body", "proxy", "fastcgi", "uwsgi", "scgi")
    )
    user = "user root;\n" if os.geteuid() == 0 else ""
    whole = folder / "nginx.conf"
    whole.write_text(
        f"{user}daemon off;\npid {folder}/pid;\nerror_log {folder}/errors;\nevents {{}}\n"
        f"http {{\naccess_log off;\n{temporary}include {folder}/site.conf;\n}}\n",
        encoding="utf-8",
    )
    running = subprocess.Popen([program, "-p", str(folder), "-c", str(whole), "-e", str(folder / "errors")])
    try:
        trusted = ssl.create_default_context(cafile=certificate)

        def answers() -> bool:
            assert running.poll() is None, (folder / "errors").read_text(encoding="utf-8")
            try:
                return httpx.get(f"https://127.0.0.1:{port}/", verify=trusted).status_code > 0
            except httpx.HTTPError:
                return False

        wait_for(answers, "nginx")
        yield
    finally:
        running.terminate()
        running.wait(20)


@pytest.fixture(scope="module")
def proxied(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Client, Laboratory]]:
    """Somebody's browser at nginx, and the server behind it."""
    folder, port = tmp_path_factory.mktemp("proxied"), free_port()
    with (
        laboratory(folder, proxy="127.0.0.1", names=f'"localhost:{port}"') as own,
        nginx(folder, port, own.port),
    ):
        client = Client(f"https://localhost:{port}", ssl.create_default_context(cafile=folder / "server.pem"))
        yield client, own
        client.close()


def test_people_sign_in_through_it_and_see_what_happens(proxied: tuple[Client, Laboratory]) -> None:
    client, _ = proxied
    client.refused(401, "GET", "/me")
    client.sign_in_as("Otto", password_of("Otto"))
    play = client.post("/play")
    begun = client.post("/activities", {"kind": "watch", "source": play["source"], "arm": play["arm"]})
    with client.socket(begun["id"]) as socket:
        assert json.loads(socket.recv(timeout=20))["activity"]["who"] == "Otto"
        assert isinstance(socket.recv(timeout=20), str | bytes)
    client.post(f"/activities/{begun['id']}/do", {"word": "end"})
    large = b"q1,q2\n" + b"0.1,0.2\n" * 500_000
    assert client.ask("POST", "/files", params={"name": "large.csv"}, content=large).status_code == 200


def test_nobody_comes_past_it(proxied: tuple[Client, Laboratory]) -> None:
    client, own = proxied
    straight = httpx.get(f"http://127.0.0.1:{own.port}/api/v1/about", headers={"Host": client.base.split("//")[1]})
    assert straight.status_code == 403
    assert client.ask("GET", "/about", headers={"X-Forwarded-Proto": "http"}).status_code == 200  # nginx says it itself


def test_the_guides_files_are_what_the_program_takes(tmp_path: Path) -> None:
    """The unit's command, with the guide's own file, at other places."""
    unit = configparser.ConfigParser(strict=False)
    unit.optionxform = str  # type: ignore[assignment]
    unit.read_string((GUIDE / "ulna-workbench.service").read_text(encoding="utf-8"))
    program, *arguments = shlex.split(unit["Service"]["ExecStart"])
    assert Path(program).name == "ulna"
    people_in(tmp_path / "bench", {"Ann": ("admin",)})
    places = {"/srv/ulna/bench": tmp_path / "bench", "/etc/ulna/workbench.toml": GUIDE / "workbench.toml"}
    done = run(*(str(places.get(each, each)) for each in arguments), "--check")
    assert done.returncode == 0, done.stderr
    assert f"https://{NAMED}" in done.stderr
    backup = configparser.ConfigParser(strict=False)
    backup.optionxform = str  # type: ignore[assignment]
    backup.read_string((GUIDE / "ulna-backup.service").read_text(encoding="utf-8"))
    _, *arguments = shlex.split(backup["Service"]["ExecStart"])
    places = {"/srv/ulna/bench": tmp_path / "bench", "/srv/backups": tmp_path / "backups"}
    (tmp_path / "backups").mkdir()
    done = run(*(str(places.get(each, each)) for each in arguments))
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "backups").iterdir())
