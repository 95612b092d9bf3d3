"""A laboratory's server for tests: in a thread, with a certificate of its own making, and people who sign in."""

from __future__ import annotations

import socket
import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime, timedelta
from ipaddress import ip_address
from pathlib import Path

from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.hazmat.primitives.asymmetric import ec
from tests.serve.servers import Client, Threaded

from ulna.records.records import Records
from ulna.serve import serving
from ulna.serve.laboratory.accounts import ACCOUNTS, Accounts
from ulna.serve.laboratory.settings_file import read_settings

PEOPLE = {
    "Ann": ("operator", "reviewer", "admin"),
    "Otto": ("operator",),
    "Rita": ("operator", "reviewer"),
    "Lea": ("reader",),
    "Nils": ("admin",),
}
"""Name → roles."""
_HASHED: dict[tuple[str, ...], bytes] = {}
"""Hashing takes its time on purpose: once for the same people is enough."""


def password_of(name: str) -> str:
    return f"correct horse of {name}"


def certificate_in(folder: Path, password: bytes | None = None) -> tuple[Path, Path]:
    """(certificate, key), PEM, of 127.0.0.1 and localhost, signed by itself."""
    key = ec.generate_private_key(ec.SECP256R1())
    name = x509.Name([x509.NameAttribute(x509.NameOID.COMMON_NAME, "localhost")])
    now = datetime.now(UTC)
    named = x509.SubjectAlternativeName([x509.DNSName("localhost"), x509.IPAddress(ip_address("127.0.0.1"))])
    made = (
        x509.CertificateBuilder()
        .subject_name(name)
        .issuer_name(name)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))
        .not_valid_after(now + timedelta(days=2))
        .add_extension(named, critical=False)
        .add_extension(x509.BasicConstraints(ca=True, path_length=None), critical=True)
        .sign(key, hashes.SHA256())
    )
    how = serialization.NoEncryption() if password is None else serialization.BestAvailableEncryption(password)
    paths = folder / "server.pem", folder / "server.key"
    paths[0].write_bytes(made.public_bytes(serialization.Encoding.PEM))
    paths[1].write_bytes(key.private_bytes(serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, how))
    return paths


def people_in(bench: Path, people: dict[str, tuple[str, ...]] = PEOPLE) -> None:
    """A record with people and their passwords."""
    record, accounts = Records.init(bench, by="root"), Accounts(bench)
    for name, roles in people.items():
        record.person(name, roles)
        if tuple(people) not in _HASHED:
            accounts.set_password(name, password_of(name))
    kept = bench / ACCOUNTS
    kept.write_bytes(_HASHED.setdefault(tuple(people), kept.read_bytes() if kept.exists() else b""))
    kept.chmod(0o600)


class Laboratory(Threaded):
    """A server in a thread of this process, for people who sign in."""

    def __init__(self, folder: Path, more: str = "", proxy: str | None = None, names: str | None = None) -> None:
        """folder: with `bench`. more: of its file. proxy: an address; None: it speaks TLS itself."""
        listening = serving.listening_at("127.0.0.1", [0], "port")
        port = listening.getsockname()[1]
        named = names or f'"127.0.0.1:{port}", "localhost:{port}"'
        path = folder / "workbench.toml"
        if proxy is None:
            certificate_in(folder)
            before = '[tls]\ncertificate = "server.pem"\nkey = "server.key"\n'
        else:
            before = f'[proxy]\naddresses = ["{proxy}"]\n'
        path.write_text(f'format = "ulna-workbench/1"\nnames = [{named}]\n{more}\n{before}', encoding="utf-8")
        settings = read_settings(path)
        self.port = port
        self._clients: list[Client] = []
        self.trusted = None if proxy is not None else ssl.create_default_context(cafile=folder / "server.pem")

        def made(workshop: object, own: socket.socket, ready: object) -> object:
            return serving.laboratory_server_of(workshop, own, settings, ready)  # type: ignore[arg-type]

        self._serve(serving.laboratory_workshop(folder / "bench", settings, "root"), listening, made)  # type: ignore[arg-type]

    def client(self) -> Client:
        """Somebody's browser, not signed in; closed with the server."""
        made = Client(self.address, self.trusted)
        self._clients.append(made)
        return made

    def of(self, name: str) -> Client:
        """Of one of `PEOPLE`, signed in."""
        return self.client().sign_in_as(name, password_of(name))

    def end(self) -> None:
        for each in self._clients:
            each.close()
        super().end()


@contextmanager
def laboratory(folder: Path, more: str = "", **how: str) -> Iterator[Laboratory]:
    """With everybody of `PEOPLE`."""
    if not (folder / "bench").exists():
        people_in(folder / "bench")
    running = Laboratory(folder, more, **how)
    try:
        yield running
    finally:
        running.end()
