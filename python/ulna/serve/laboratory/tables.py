"""The file of a laboratory's server, `ulna-workbench/1`: by which names it is reached, and how people sign in."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from ulna.formats.models import Strict

FORMAT: Literal["ulna-workbench/1"] = "ulna-workbench/1"
Word = Annotated[str, Field(min_length=1, max_length=300)]


class ListenTable(Strict):
    """Where the server listens."""

    address: Word = "0.0.0.0"
    """Of this machine; 127.0.0.1 where a proxy on it stands before it."""
    port: Annotated[int, Field(ge=0, le=65535)] = 8443


class TlsTable(Strict):
    """Its own certificate, PEM."""

    certificate: Word
    """File with the certificate and those that it rests on."""
    key: Word
    """File with its key, which the server's user alone should read."""


class ProxyTable(Strict):
    """A reverse proxy before it, which speaks TLS and says so in X-Forwarded-Proto."""

    addresses: Annotated[list[Word], Field(min_length=1, max_length=20)]
    """Of the proxy, as the server sees it: nobody else is answered."""


class ProviderTable(Strict):
    """An OpenID provider, at which people sign in."""

    issuer: Word
    """As the provider calls itself: https://login.lab.example/realms/lab."""
    client_id: Word
    secret_file: Word | None = None
    """File with the client's secret; none: a public client (PKCE alone)."""
    claim: Literal["email", "preferred_username", "sub"] = "email"
    """By what of the ID token somebody is known; an email counts only if the provider verified it."""
    title: Word = "OpenID"
    """What its button says."""


class SignInTable(Strict):
    """How long, and how."""

    hours: Annotated[float, Field(gt=0, le=168)] = 12.0
    """Until somebody must sign in anew."""
    passwords: bool = True
    """Whether names with passwords are taken."""


class SourcesTable(Strict):
    """What the server may read readings from when somebody in a browser asks it to."""

    hosts: Annotated[list[Word], Field(max_length=200, default_factory=list)]
    """Names or addresses of machines that it may connect to; none: to none."""
    serial: bool = True
    """Whether the serial ports of this machine may be opened."""


class WorkbenchFile(Strict):
    """All of it. Either [tls] or [proxy]; paths are seen from the file."""

    format: Literal["ulna-workbench/1"]
    names: Annotated[list[Word], Field(min_length=1, max_length=20)]
    """As browsers call it: "arms.lab.example", with ":8443" where the port is not 443."""
    listen: ListenTable = ListenTable()
    tls: TlsTable | None = None
    proxy: ProxyTable | None = None
    provider: ProviderTable | None = None
    sign_in: SignInTable = SignInTable()
    sources: SourcesTable = SourcesTable(hosts=[])
