"""The file of a laboratory's server, and what is looked at before it serves."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest
from tests.cli_runs import assert_bad_input, run
from tests.serve.laboratories import certificate_in, people_in

from ulna.records.records import Records
from ulna.serve.laboratory.accounts import Accounts

TLS = '[tls]\ncertificate = "server.pem"\nkey = "server.key"\n'
PROVIDER = '[provider]\nissuer = "https://b.example"\nclient_id = "x"\n'
PROXY = '[proxy]\naddresses = ["127.0.0.1"]\n'


def told(line: str, *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """The program, with something to read."""
    return subprocess.run(
        [sys.executable, "-m", "ulna", *map(str, arguments)],
        input=line,
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"COLUMNS": "80", "TERM": "dumb"},
        check=False,
    )


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('names = ["a.example"]\n', "neither of [tls] and [proxy]"),
        (f'names = ["a.example"]\n{TLS}{PROXY}', "both of [tls] and [proxy]"),
        (f"names = []\n{TLS}", "names"),
        (f'names = ["https://a.example/"]\n{TLS}', "https://a.example/"),
        (f'names = ["a.example"]\n{TLS.replace("server.pem", "no.pem")}', "no.pem"),
        (f'names = ["a.example"]\n{TLS.replace("server.key", "locked.key")}', "without a password"),
        (f'names = ["a.example"]\n{TLS.replace("server.pem", "server.key")}', "cannot be used"),
        (f'names = ["a.example"]\n{PROXY.replace("127.0.0.1", "proxy.example")}', "an IP address"),
        (f'names = ["a.example"]\n{TLS}[sign_in]\npasswords = false\n', "nobody can sign in"),
        (f'names = ["a.example"]\n{TLS}{PROVIDER.replace("https", "http")}', "expected https"),
        (f'names = ["a.example"]\n{TLS}{PROVIDER}secret_file = "no"\n', "cannot be read"),
        (f'names = ["a.example"]\nport = 1\n{TLS}', "port"),
    ],
)
def test_a_file_that_would_not_do_is_refused_before_anything_listens(tmp_path: Path, text: str, said: str) -> None:
    certificate_in(tmp_path, b"secret")[1].rename(tmp_path / "locked.key")
    certificate_in(tmp_path)
    file = tmp_path / "workbench.toml"
    file.write_text(f'format = "ulna-workbench/1"\n{text}', encoding="utf-8")
    assert_bad_input(run("workbench", tmp_path / "bench", "--laboratory", file, "--check"), said)
    assert not (tmp_path / "bench").exists()


def test_it_says_whether_it_could_serve(tmp_path: Path) -> None:
    bench, file = tmp_path / "bench", tmp_path / "workbench.toml"
    file.write_text(f'format = "ulna-workbench/1"\nnames = ["a.example"]\n{PROXY}', encoding="utf-8")
    assert_bad_input(run("workbench", bench, "--laboratory", file, "--check"), "nobody could sign in")
    record = ("--records", bench)
    assert_bad_input(told("x" * 12, "record", "account", "Ann", *record, "--password-stdin"), "has no role")
    assert run("record", "person", "Ann", "--role", "operator", *record).returncode == 0
    assert_bad_input(told("short\n", "record", "account", "Ann", *record, "--password-stdin"), "12")
    assert_bad_input(run("record", "account", "Ann", *record), "--password-stdin")
    done = told("three or four words\n", "record", "account", "Ann", *record, "--password-stdin")
    assert done.returncode == 0, done.stderr
    kept = bench / "accounts.json"
    assert stat.S_IMODE(kept.stat().st_mode) == 0o600
    assert "three or four" not in kept.read_text(encoding="utf-8")
    assert "argon2id" in kept.read_text(encoding="utf-8")
    done = run("workbench", bench, "--laboratory", file, "--check")
    assert done.returncode == 0, done.stderr
    assert "no admin can sign in" in done.stderr
    assert "second person" in done.stderr
    assert_bad_input(run("workbench", bench, "--laboratory", file, "--port", "1"), "--port")
    assert_bad_input(run("workbench", bench, "--check"), "--laboratory")
    assert run("record", "account", "Ann", *record, "--remove").returncode == 0
    assert_bad_input(run("workbench", bench, "--laboratory", file, "--check"), "nobody could sign in")


def test_an_export_of_the_record_has_no_passwords_in_it(tmp_path: Path) -> None:
    people_in(tmp_path / "bench", {"Ann": ("admin",)})
    made = Records.open(tmp_path / "bench").export(tmp_path / "out.zip")
    assert b"argon2" not in made.path.read_bytes()
    again = Records.from_export(made.path, tmp_path / "again")
    assert again.people() == {"Ann": ("admin",)}
    assert Accounts(tmp_path / "again").all() == {}
