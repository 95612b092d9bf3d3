"""Reading `ulna-workbench/1`: what can be wrong in it is said before anything listens."""

from __future__ import annotations

import ipaddress
import re
import ssl
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

from ulna.formats.models import fill
from ulna.formats.toml import check_format, read_toml
from ulna.ground.errors import UlnaInputError
from ulna.serve.laboratory.tables import ProviderTable, WorkbenchFile

_NAME = re.compile(r"(?:[a-z0-9](?:[a-z0-9.-]*[a-z0-9])?|\[[0-9a-f:.]+\])(?::[1-9][0-9]{0,4})?")


@dataclass(frozen=True)
class Settings:
    """What it says, checked."""

    file: WorkbenchFile
    certificate: Path | None
    key: Path | None
    secret: str | None
    """Of the provider's client."""

    @property
    def origin(self) -> str:
        """Under which it is reached: https://arms.lab.example."""
        return f"https://{self.file.names[0]}"


def read_settings(path: Path) -> Settings:
    """Raises UlnaInputError."""
    document, _ = read_toml(path, 'a file of a laboratory\'s workbench (TOML, format = "ulna-workbench/1")')
    check_format(document, path, "ulna-workbench")
    file = fill(WorkbenchFile, document, path)
    for name in file.names:
        if not _NAME.fullmatch(name):
            raise UlnaInputError(
                f"{path}: key 'names': got '{name[:80]}', expected a host as a browser's address has it, in small "
                "letters, such as arms.lab.example or arms.lab.example:8443. Correct it."
            )
    if (file.tls is None) == (file.proxy is None):
        got = "neither" if file.tls is None else "both"
        raise UlnaInputError(
            f"{path}: got {got} of [tls] and [proxy]; expected one: passwords and readings must not go over a network "
            "in the clear. Give a certificate, or name the proxy that has one."
        )
    if file.proxy is not None:
        _addresses(path, file.proxy.addresses)
    certificate, key = (
        (None, None) if file.tls is None else (path.parent / file.tls.certificate, path.parent / file.tls.key)
    )
    if certificate is not None and key is not None:
        _loaded(path, certificate, key)
    if file.provider is None and not file.sign_in.passwords:
        raise UlnaInputError(f"{path}: nobody can sign in; expected [provider], or sign_in.passwords. Give one.")
    return Settings(file, certificate, key, None if file.provider is None else _secret(path, file.provider))


def _addresses(path: Path, addresses: list[str]) -> None:
    for each in addresses:
        try:
            ipaddress.ip_address(each)
        except ValueError:
            raise UlnaInputError(
                f"{path}: key 'proxy.addresses': got '{each[:80]}', expected an IP address, such as 127.0.0.1. "
                "Correct it."
            ) from None


def _loaded(path: Path, certificate: Path, key: Path) -> None:
    for name, file in (("certificate", certificate), ("key", key)):
        if not file.is_file():
            raise UlnaInputError(f"{path}: key 'tls.{name}': {file} is not there; expected a PEM file. Correct it.")
    try:
        ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER).load_cert_chain(certificate, key, password=_no_password)
    except (OSError, ValueError) as error:
        raise UlnaInputError(
            f"{path}: {certificate.name} and {key.name} cannot be used ({error}); expected a certificate and its own "
            "key, PEM, without a password. Correct them."
        ) from None


def _no_password() -> str:
    raise ValueError("the key has a password")


def _secret(path: Path, stated: ProviderTable) -> str | None:
    parts = urlsplit(stated.issuer)
    if parts.scheme != "https" and (parts.scheme != "http" or parts.hostname not in ("127.0.0.1", "localhost", "::1")):
        raise UlnaInputError(
            f"{path}: key 'provider.issuer': got '{stated.issuer[:80]}', expected https://. Correct it."
        )
    if stated.secret_file is None:
        return None
    file = path.parent / stated.secret_file
    try:
        secret = file.read_text(encoding="utf-8").strip()
    except (OSError, UnicodeDecodeError):
        raise UlnaInputError(
            f"{path}: key 'provider.secret_file': {file} cannot be read; expected the client's secret. Correct it."
        ) from None
    if not secret or len(secret) > 500 or not secret.isprintable():
        raise UlnaInputError(f"{file}: holds no secret; expected one line. Correct it.")
    return secret
