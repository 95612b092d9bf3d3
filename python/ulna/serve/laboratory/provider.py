"""Signing in at an OpenID provider: authorization code flow with PKCE, state and nonce (OpenID Connect Core 1.0, 3.1).

What a provider says is believed only if its signature, issuer, audience, time and nonce are right; all of it by
Authlib.
"""

from __future__ import annotations

import secrets
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import httpx2
from authlib.common.errors import AuthlibBaseError
from authlib.integrations.base_client import OAuthError
from authlib.integrations.httpx_client import OAuth2Client
from authlib.oidc.core import CodeIDToken
from joserfc import jwt
from joserfc.errors import JoseError
from joserfc.jwk import KeySet
from joserfc.jws import JWSRegistry

from ulna.serve.guests import BEGUN_S
from ulna.serve.laboratory.tables import ProviderTable
from ulna.serve.problems import ProviderError

SIGNED_BY = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "EdDSA")
"""Of a token, by a key that only the provider has: never by a shared one, never by none."""
BACK = "/api/v1/provider/back"
WAIT_S, LEEWAY_S = 10.0, 60
_MOST = 1000


@dataclass(frozen=True)
class _Begun:
    nonce: str
    verifier: str
    until_s: float


class Provider:
    """One, for one server."""

    def __init__(self, stated: ProviderTable, secret: str | None, origin: str) -> None:
        """origin: of this server, as browsers have it."""
        self.title = stated.title
        self._stated, self._secret, self._back = stated, secret, origin + BACK
        self._lock = threading.Lock()
        self._begun: dict[str, _Begun] = {}

    def begin(self) -> tuple[str, str]:
        """Where to send a browser, and the state by which it is known when it comes back. Raises ProviderError."""
        said = self._metadata()
        begun = _Begun(secrets.token_urlsafe(24), secrets.token_urlsafe(48), time.monotonic() + BEGUN_S)
        with self._client() as client:
            url, state = client.create_authorization_url(
                _text(said, "authorization_endpoint"), code_verifier=begun.verifier, nonce=begun.nonce
            )
        now_s = time.monotonic()
        with self._lock:
            self._begun = {key: each for key, each in self._begun.items() if each.until_s > now_s}
            while len(self._begun) >= _MOST:
                del self._begun[next(iter(self._begun))]
            self._begun[str(state)] = begun
        return str(url), str(state)

    def finish(self, state: str, query: str) -> str:
        """What the provider calls whoever came back; each state counts once. query: of the address that they came back
        to. Raises ProviderError."""
        with self._lock:
            begun = self._begun.pop(state, None)
        if begun is None or begun.until_s < time.monotonic():
            raise ProviderError("sign-in: it was not begun here, or too long ago. Begin anew.")
        said = self._metadata()
        try:
            with self._client() as client:
                token = client.fetch_token(
                    _text(said, "token_endpoint"),
                    authorization_response=f"{self._back}?{query}",
                    code_verifier=begun.verifier,
                    state=state,
                )
                keys = client.request("GET", _text(said, "jwks_uri"), withhold_token=True).raise_for_status().json()
            return self._believed(said, token, keys, begun.nonce)
        except (httpx2.HTTPError, OAuthError, AuthlibBaseError, JoseError, ValueError, TypeError, KeyError) as error:
            raise ProviderError(f"{self._stated.issuer}: {type(error).__name__}: {error}. Try again.") from None

    def _believed(self, said: Mapping[str, Any], token: Mapping[str, Any], keys: Any, nonce: str) -> str:
        signed = jwt.decode(
            str(token["id_token"]),
            KeySet.import_key_set(keys),
            registry=JWSRegistry(algorithms=list(SIGNED_BY), strict_check_header=False),
        )
        stated = self._stated
        claims = CodeIDToken(
            signed.claims,
            signed.header,
            {
                "iss": {"essential": True, "value": said["issuer"]},
                "aud": {"essential": True, "value": stated.client_id},
            },
            {"nonce": nonce, "client_id": stated.client_id, "access_token": token.get("access_token")},
        )
        claims.validate(leeway=LEEWAY_S)
        known = {**claims}
        if stated.claim not in known:
            known = self._asked(said, token, str(claims["sub"]))
        if stated.claim == "email" and known.get("email_verified") is not True:
            raise ValueError("the address is not verified")
        found = known[stated.claim]
        if not (isinstance(found, str) and found):
            raise ValueError(f"no {stated.claim}")
        return found

    def _asked(self, said: Mapping[str, Any], token: Mapping[str, Any], subject: str) -> dict[str, Any]:
        """What the token did not say, by the endpoint for it; of the same person."""
        with self._client(dict(token)) as client:
            found = client.request("GET", _text(said, "userinfo_endpoint")).raise_for_status().json()
        if not isinstance(found, dict) or found.get("sub") != subject:
            raise ValueError("what is said of a person is of another one")
        return found

    def _metadata(self) -> dict[str, Any]:
        url = f"{self._stated.issuer.rstrip('/')}/.well-known/openid-configuration"
        try:
            with httpx2.Client(timeout=WAIT_S) as client:
                said = client.get(url).raise_for_status().json()
        except (httpx2.HTTPError, httpx2.InvalidURL, ValueError) as error:
            raise ProviderError(f"{url}: cannot be read ({type(error).__name__}: {error}). Try again later.") from None
        if not isinstance(said, dict) or said.get("issuer") != self._stated.issuer:
            raise ProviderError(
                f"{url}: is of another issuer; expected {self._stated.issuer}. Correct provider.issuer."
            )
        return said

    def _client(self, token: dict[str, Any] | None = None) -> OAuth2Client:
        return OAuth2Client(
            client_id=self._stated.client_id,
            client_secret=self._secret,
            scope="openid email profile",
            redirect_uri=self._back,
            token=token,
            token_endpoint_auth_method="none" if self._secret is None else "client_secret_basic",
            code_challenge_method="S256",
            timeout=WAIT_S,
        )


def _text(said: Mapping[str, Any], key: str) -> str:
    found = said.get(key)
    if not isinstance(found, str):
        raise ProviderError(f"provider: says no {key}; expected an OpenID provider. Correct provider.issuer.")
    return found
