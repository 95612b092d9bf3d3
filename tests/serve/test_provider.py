"""Signing in at an OpenID provider: the certified one of Node, for real, and what is not believed."""

from __future__ import annotations

import base64
import hmac
import time
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import httpx
import pytest
from joserfc import jwt
from joserfc.errors import JoseError
from joserfc.jwk import RSAKey
from tests.serve.laboratories import Laboratory, laboratory, people_in
from tests.serve.openid import browse, free_port, provider, stated

from ulna.records.records import Records
from ulna.serve.laboratory.accounts import Accounts
from ulna.serve.laboratory.provider import Provider
from ulna.serve.laboratory.tables import ProviderTable

BEGIN = "/api/v1/provider/begin"


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Laboratory]:
    """Erika and two others sign in there; nobody has a password."""
    folder = tmp_path_factory.mktemp("provider")
    record, accounts = Records.init(folder / "bench", by="root"), Accounts(folder / "bench")
    for name, roles in {"Erika Muster": ("operator",), "Not Verified": ("admin",), "Gone": ()}.items():
        record.person(name, roles)
    accounts.set_sign_in("Erika Muster", "erika@lab.example")
    accounts.set_sign_in("Not Verified", "unverified@lab.example")
    accounts.set_sign_in("Gone", "gone@lab.example")
    port = free_port()
    with (
        laboratory(folder, stated(folder, port) + "[sign_in]\npasswords = false\n") as own,
        provider(own, port),
    ):
        yield own


@pytest.fixture
def browser(lab: Laboratory) -> Iterator[httpx.Client]:
    assert lab.trusted is not None
    with httpx.Client(verify=lab.trusted, timeout=30.0) as made:
        yield made


def test_somebody_comes_in_as_the_provider_knows_them(lab: Laboratory, browser: httpx.Client) -> None:
    about = lab.client().get("/about")
    assert (about["ways"], about["provider"]) == (["provider"], "the house's login")
    answer = browse(browser, lab.address + BEGIN, "erika", lab.address)
    assert answer.headers["location"] == "/"
    assert "SameSite=strict" in answer.headers["set-cookie"]
    me = browser.get(f"{lab.address}/api/v1/me").json()
    assert me == {"name": "Erika Muster", "roles": ["reader", "operator"], "password": False}
    again = browser.get(str(answer.request.url))  # the same way back, a second time
    assert again.headers["location"] == "/#sign-in=refused"


@pytest.mark.parametrize(("login", "said"), [("stranger", "unknown"), ("gone", "unknown"), ("unverified", "refused")])
def test_whoever_is_nobody_here_does_not(lab: Laboratory, browser: httpx.Client, login: str, said: str) -> None:
    answer = browse(browser, lab.address + BEGIN, login, lab.address)
    assert answer.headers["location"] == f"/#sign-in={said}"
    assert browser.get(f"{lab.address}/api/v1/me").status_code == 401


def test_a_way_back_that_this_browser_did_not_begin_leads_nowhere(lab: Laboratory, browser: httpx.Client) -> None:
    """Somebody is sent a link by which they would sign in as another."""
    begun = browser.get(lab.address + BEGIN)
    state = parse_qs(urlsplit(begun.headers["location"]).query)["state"][0]
    back = f"{lab.address}/api/v1/provider/back?code=x&state={state}"
    assert lab.trusted is not None
    with httpx.Client(verify=lab.trusted) as other:
        assert other.get(back).headers["location"] == "/#sign-in=refused"
    assert browser.get(back).headers["location"] == "/#sign-in=refused"  # it is theirs, but the code is made up
    for query in ("", "?code=x", "?state=", "?error=access_denied&state=x"):
        assert browser.get(f"{lab.address}/api/v1/provider/back{query}").headers["location"] == "/#sign-in=refused"


def test_what_is_asked_of_the_provider(lab: Laboratory, browser: httpx.Client) -> None:
    begun = browser.get(lab.address + BEGIN)
    asked = parse_qs(urlsplit(begun.headers["location"]).query)
    assert asked["code_challenge_method"] == ["S256"]
    assert asked["response_type"] == ["code"]
    assert len(asked["nonce"][0]) >= 20
    assert len(asked["state"][0]) >= 20
    assert asked["redirect_uri"] == [f"{lab.address}/api/v1/provider/back"]
    cookie = begun.headers["set-cookie"]
    for word in ("HttpOnly", "SameSite=lax", "Secure"):
        assert word in cookie


def test_a_password_is_no_way_in_where_there_are_none(lab: Laboratory) -> None:
    asked = {"way": "password", "name": "Erika Muster", "password": "x"}
    assert "provider" in lab.client().refused(401, "POST", "/login", json=asked)


def test_a_provider_that_is_not_there_is_said(tmp_path: Path) -> None:
    people_in(tmp_path / "bench", {"Ann": ("admin",)})
    with laboratory(tmp_path, stated(tmp_path, free_port())) as own:
        assert own.client().get("/about")["ways"] == ["password", "provider"]
        answer = own.client().ask("GET", "/provider/begin")
        assert answer.headers["location"] == "/#sign-in=silent"


SAID = {"issuer": "https://login.example"}
GOOD = {
    "iss": "https://login.example",
    "aud": "ulna",
    "sub": "1",
    "nonce": "n",
    "email": "erika@lab.example",
    "email_verified": True,
}


def _coded(content: bytes) -> str:
    return base64.urlsafe_b64encode(content).decode().rstrip("=")


def token(key: RSAKey, algorithm: str, **more: object) -> str:
    now = int(time.time())
    claims = {**GOOD, "iat": now, "exp": now + 60, **more}
    return jwt.encode({"alg": algorithm}, {k: v for k, v in claims.items() if v is not None}, key, [algorithm])


def test_only_a_token_that_is_right_in_all_is_believed() -> None:
    own = Provider(ProviderTable(issuer="https://login.example", client_id="ulna"), None, "https://arms.example")
    key, other = RSAKey.generate_key(2048, auto_kid=False), RSAKey.generate_key(2048, auto_kid=False)
    keys = {"keys": [key.as_dict(private=False)]}

    def believed(text: str) -> str:
        return own._believed(SAID, {"id_token": text}, keys, "n")

    assert believed(token(key, "RS256")) == "erika@lab.example"
    now = int(time.time())
    wrong: list[str] = [
        token(key, "RS256", iss="https://evil.example"),
        token(key, "RS256", iss=None),
        token(key, "RS256", aud="another"),
        token(key, "RS256", aud=["another", "ulna"], azp="another"),
        token(key, "RS256", aud=None),
        token(key, "RS256", nonce="m"),
        token(key, "RS256", nonce=None),
        token(key, "RS256", exp=now - 3600),
        token(key, "RS256", exp=None),
        token(key, "RS256", iat=now + 3600),
        token(key, "RS256", sub=None),
        token(key, "RS256", email_verified=False),
        token(key, "RS256", email_verified="true"),
        token(key, "RS256", email_verified=None),
        token(other, "RS256"),
    ]
    head, body, _ = token(key, "RS256").split(".")
    none, shared = _coded(b'{"alg":"none"}'), _coded(b'{"alg":"HS256"}')
    by_public = hmac.digest(key.as_pem(private=False), f"{shared}.{body}".encode(), "sha256")
    wrong += [f"{none}.{body}.", f"{head}.{body}.", f"{shared}.{body}.{_coded(by_public)}", "x"]
    for text in wrong:
        with pytest.raises((JoseError, ValueError)):
            believed(text)
