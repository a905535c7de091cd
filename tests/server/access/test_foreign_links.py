"""Links that pages of other sites lead to: they let in, and take nobody's role away."""

from __future__ import annotations

import http.server
import itertools
import re
import threading
from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest

from tests.server.access.conftest import House
from webviz.api.roles import Role
from webviz.server.access.roles import LINKS

PARAMETERS = {role: name for name, role in LINKS.items()}


def link(house: House, role: Role) -> str:
    return f"/?{PARAMETERS[role]}={house.tokens[role].secret}"


def given(house: House, role: Role, **headers: str) -> str:
    """The cookie with which a browser leaves that opens a link and goes where it is sent."""
    cookie, path = headers.pop("Cookie", ""), link(house, role)
    for _ in range(3):
        response = house.ask(path, Cookie=cookie, **headers)
        if set_cookie := response.headers["Set-Cookie"]:
            cookie = "; ".join(filter(None, (cookie, set_cookie.partition(";")[0])))
        if response.status == 303:
            assert response.headers["Location"] == "./"
            return set_cookie and cookie.rpartition("; ")[2]
        path = response.headers["Refresh"].removeprefix("0; url=.")
        headers = {}
    raise AssertionError("sent on and on")


@pytest.mark.parametrize("headers", [{}, {"Sec_Fetch_Site": "cross-site"}])
def test_a_link_of_another_site_is_opened_again_by_this_one(
    house: House, headers: dict[str, str]
) -> None:
    response = house.ask(link(house, Role.WATCHER), **headers)
    assert response.status == 200
    assert "Location" not in response.headers
    assert house.tokens[Role.WATCHER].cookie not in response.headers["Set-Cookie"]
    assert "HttpOnly; SameSite=Strict" in response.headers["Set-Cookie"]
    with_view = f"{link(house, Role.WATCHER)}&a=1"  # not sent on yet, whatever else it carries
    assert house.ask(with_view, **headers).status == 200
    assert given(house, Role.WATCHER, **headers) == house.cookie(Role.WATCHER)


def test_a_link_takes_no_role_away_unless_its_user_has_entered_it(house: House) -> None:
    sites = (None, "same-site", "same-origin", "none")
    for before, role, site in itertools.product(Role, Role, sites):
        headers = {} if site is None else {"Sec_Fetch_Site": site}
        cookie = given(house, role, Cookie=house.cookie(before), **headers)
        expected = house.cookie(role) if role >= before or site == "none" else None
        assert cookie == expected, (before, role, site)


def test_a_browser_without_cookies_is_told_so_and_not_sent_on_and_on(house: House) -> None:
    again = house.ask(link(house, Role.OWNER)).headers["Refresh"].removeprefix("0; url=.")
    response = house.ask(again)
    assert response.status == 403
    assert b"keeps no cookies" in house.body
    assert "Set-Cookie" not in response.headers


@pytest.fixture
def foreign(house: House) -> Iterator[str]:
    """The address of another site, whose page leads to the viewer as a watcher."""
    target = f"http://localhost:{house.server.get_port()}{link(house, Role.WATCHER)}"

    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(f"<a href='{target}'>webviz</a>".encode())

        def log_message(self, format: str, *args: object) -> None:
            pass

    site = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)
    threading.Thread(target=site.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{site.server_port}/"
    site.shutdown()
    site.server_close()


@pytest.mark.parametrize("before", [None, Role.OWNER])
def test_a_page_of_another_site_leads_a_real_browser_in_and_makes_no_owner_a_watcher(
    house: House, browser: playwright.Browser, foreign: str, before: Role | None
) -> None:
    context = browser.new_context(java_script_enabled=False)
    try:
        tab = context.new_page()
        home = f"http://localhost:{house.server.get_port()}"
        if before is not None:
            tab.goto(home + link(house, before))
            playwright.expect(tab).to_have_url(f"{home}/")
        tab.goto(foreign)
        tab.get_by_text("webviz").click()
        playwright.expect(tab).to_have_url(re.compile(f"^{home}/$"))
        held = {f"{each.get('name')}={each.get('value')}" for each in context.cookies()}
        assert house.cookie(before or Role.WATCHER) in held
    finally:
        context.close()
