"""A laboratory in the browser: people sign in, an admin enters one, a certificate needs two; over TLS."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.conftest import ROOT
from tests.page.conftest import NARROW, PATIENCE_MS, WIDE
from tests.page.test_screens import check
from tests.real_parts import lacking
from tests.records.benches import RESULT
from tests.serve.laboratories import Laboratory, laboratory, password_of
from tests.serve.openid import free_port, provider, stated

from ulna.serve.laboratory.accounts import Accounts
from ulna.serve.page import there

STATED = ROOT / "examples" / "platinum" / "laboratory.toml"


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Laboratory]:
    """With a provider beside passwords."""
    if not there():
        lacking("the built page (make page, with Node 20.19)")
    folder, port = tmp_path_factory.mktemp("laboratory"), free_port()
    with laboratory(folder, stated(folder, port)) as own, provider(own, port):
        Accounts(folder / "bench").set_sign_in("Otto", "otto@lab.example")
        otto = own.of("Otto")
        otto.post("/records/equipment", {"name": "P7", "kind": "arm"})
        otto.post("/records/add", {"files": [otto.bring(RESULT)], "arm": "P7", "at": "2026-01-01"})
        otto.bring(STATED)
        yield own


def signed_in(opened: Callable[..., Any], name: str, language: str = "en", **more: Any) -> Any:
    page = opened(language, ignore_https_errors=True, **more)
    form = page.locator("form")
    form.locator("input[autocomplete=username]").fill(name)
    form.locator("input[type=password]").fill(password_of(name))
    form.locator("button[type=submit]").click()
    page.get_by_role("button", name=re.compile(name)).wait_for()
    return page


@pytest.mark.parametrize(("language", "size"), [("en", WIDE), ("de", NARROW), ("zh", NARROW)])
def test_the_door(opened: Callable[..., Any], pictures: Path, language: str, size: dict[str, int]) -> None:
    page = opened(language, size, ignore_https_errors=True)
    page.get_by_role("link", name=re.compile("the house's login")).wait_for()
    page.screenshot(path=str(pictures / f"door-{language}.png"))
    check(page, f"the door, {language}")
    page.locator("input[autocomplete=username]").fill("Lea")
    page.locator("input[type=password]").fill("a guess")
    page.keyboard.press("Enter")
    page.get_by_role("alert").wait_for()
    check(page, f"the door after a guess, {language}")


def test_somebody_is_entered_and_signs_in(opened: Callable[..., Any], server: Laboratory, pictures: Path) -> None:
    ann = signed_in(opened, "Ann")
    ann.get_by_role("link", name="People").click()
    ann.get_by_role("heading", name="Rules for certificates").wait_for()
    form = ann.locator("#person form")
    form.get_by_label("Name").fill("Neu Hier")
    form.get_by_role("button", name="Enter a person").click()
    row = ann.get_by_role("row").filter(has_text="Neu Hier")
    row.get_by_text("cannot sign in").wait_for()
    row.get_by_role("button", name="Sign-in of Neu Hier").click()
    dialog = ann.get_by_role("dialog")
    check(ann, "an account")
    dialog.get_by_label("New password").fill(password_of("Neu Hier"))
    dialog.get_by_role("button", name="Keep").click()
    row.get_by_text("password").wait_for()
    ann.get_by_label("A second person must approve").check()
    ann.get_by_label("Numbers").fill("XY-{year}-{n:03}")
    ann.get_by_role("button", name="Keep").click()
    ann.get_by_text("It counts from now on").wait_for()
    check(ann, "people")
    ann.screenshot(path=str(pictures / "people.png"), full_page=True)
    fresh = signed_in(opened, "Neu Hier")
    assert fresh.get_by_role("link", name="People").count() == 0
    fresh.get_by_role("button", name="Neu Hier").click()
    fresh.get_by_text("Roles: reader, operator").wait_for()
    check(fresh, "who one is")
    fresh.screenshot(path=str(pictures / "who.png"))
    fresh.get_by_role("button", name="Sign out").click()
    fresh.get_by_role("heading", name="Sign in").wait_for()
    fresh.reload()
    fresh.get_by_role("heading", name="Sign in").wait_for()


@pytest.mark.parametrize("size", [WIDE, NARROW])
def test_whoever_looks_is_told_so(
    opened: Callable[..., Any], pictures: Path, size: dict[str, int], server: Laboratory
) -> None:
    lea = signed_in(opened, "Lea", "de", size=size)
    lea.get_by_text("Ändern dürfen nur Bediener").wait_for()
    lea.locator("main h1").first.wait_for()
    lea.wait_for_load_state("networkidle")
    check(lea, "a reader's bench")
    lea.screenshot(path=str(pictures / f"reader-{size['width']}.png"))
    lea.goto(f"{server.address}/people")
    lea.get_by_role("alert").wait_for()


def test_a_certificate_by_two_people(opened: Callable[..., Any], server: Laboratory, pictures: Path) -> None:
    otto, rita = signed_in(opened, "Otto"), signed_in(opened, "Rita")
    server.of("Ann").post("/settings", {"four_eyes": True})
    otto.goto(f"{server.address}/certificate?arm=P7")
    otto.get_by_role("heading", name="Propose a certificate").wait_for()
    otto.locator("input[type=file]").first.set_input_files(str(STATED))
    otto.get_by_role("button", name="Propose a certificate").click()
    otto.get_by_text("A reviewer looks at it").wait_for()
    check(otto, "a proposal")
    otto.screenshot(path=str(pictures / "proposed.png"), full_page=True)
    rita.goto(f"{server.address}/certificate")
    rita.get_by_role("button", name="Approve and issue").click()
    row = rita.get_by_role("row").filter(has_text="Otto / Rita")
    row.wait_for()
    check(rita, "an approval")
    rita.screenshot(path=str(pictures / "approved.png"), full_page=True)
    (issued,) = server.of("Rita").get("/records/certificates")["certificates"]
    assert (issued["issued_by"], issued["approved_by"]) == ("Otto", "Rita")


def test_whoever_is_put_out_is_asked_to_sign_in(opened: Callable[..., Any], server: Laboratory) -> None:
    lea = signed_in(opened, "Lea")
    server.guests.out("Lea")
    lea.get_by_role("link", name="Records").click()
    lea.get_by_role("heading", name="Sign in").wait_for()


def test_by_the_provider_in_a_real_browser(browser: Any, server: Laboratory) -> None:
    """Cookies go the way there and back as browsers let them."""
    context = browser.new_context(ignore_https_errors=True, locale="en")
    context.set_default_timeout(PATIENCE_MS)
    page = context.new_page()
    page.goto(server.address)
    page.get_by_role("link", name=re.compile("the house's login")).click()
    page.locator("input[name=login]").fill("otto")
    page.locator("input[name=password]").fill("x")
    page.get_by_role("button", name=re.compile("sign-in", re.IGNORECASE)).click()
    page.get_by_role("button", name=re.compile("continue", re.IGNORECASE)).click()
    page.get_by_role("button", name="Otto").wait_for()
    assert page.url.rstrip("/") == server.address
    context.close()
