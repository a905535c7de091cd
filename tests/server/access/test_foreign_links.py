"""Links that pages of other sites lead to: they let in, and take nobody's role away."""

from __future__ import annotations

import http.server
import itertools
import re
from collections.abc import Iterator

import playwright.sync_api as playwright
import pytest
from serving import serving

from tests.server.access.conftest import TokenServer
from webviz.api.roles import Role
from webviz.server.access.roles import LINKS

PARAMETERS = {role: name for name, role in LINKS.items()}


def link(token_server: TokenServer, role: Role) -> str:
    return f"/?{PARAMETERS[role]}={token_server.tokens[role].secret}"


def granted_cookie(token_server: TokenServer, role: Role, **headers: str) -> str:
    """The cookie with which a browser leaves that opens a link and goes where it is sent."""
    cookie, path = headers.pop("Cookie", ""), link(token_server, role)
    for _ in range(3):
        response = token_server.ask(path, Cookie=cookie, **headers)
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
    token_server: TokenServer, headers: dict[str, str]
) -> None:
    response = token_server.ask(link(token_server, Role.WATCHER), **headers)
    assert response.status == 200
    assert "Location" not in response.headers
    assert token_server.tokens[Role.WATCHER].cookie not in response.headers["Set-Cookie"]
    assert "HttpOnly; SameSite=Strict" in response.headers["Set-Cookie"]
    with_view = (
        f"{link(token_server, Role.WATCHER)}&a=1"  # not sent on yet, whatever else it carries
    )
    assert token_server.ask(with_view, **headers).status == 200
    assert granted_cookie(token_server, Role.WATCHER, **headers) == token_server.cookie(
        Role.WATCHER
    )


def test_a_link_takes_no_role_away_unless_its_user_has_entered_it(
    token_server: TokenServer,
) -> None:
    sites = (None, "same-site", "same-origin", "none")
    for before, role, site in itertools.product(Role, Role, sites):
        headers = {} if site is None else {"Sec_Fetch_Site": site}
        cookie = granted_cookie(token_server, role, Cookie=token_server.cookie(before), **headers)
        expected = token_server.cookie(role) if role >= before or site == "none" else None
        assert cookie == expected, (before, role, site)


def test_a_browser_without_cookies_gets_an_error_instead_of_redirections(
    token_server: TokenServer,
) -> None:
    again = (
        token_server.ask(link(token_server, Role.OWNER)).headers["Refresh"].removeprefix("0; url=.")
    )
    response = token_server.ask(again)
    assert response.status == 403
    assert b"blocks the cookies" in token_server.body
    assert "Set-Cookie" not in response.headers


@pytest.fixture
def foreign(token_server: TokenServer) -> Iterator[str]:
    """The address of another site, whose page leads to the viewer as a watcher."""
    target = f"http://localhost:{token_server.server.get_port()}{link(token_server, Role.WATCHER)}"

    class Page(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(f"<a href='{target}'>webviz</a>".encode())

        def log_message(self, format: str, *args: object) -> None:
            pass

    with serving(http.server.ThreadingHTTPServer(("127.0.0.1", 0), Page)) as site:
        yield f"http://127.0.0.1:{site.server_port}/"


@pytest.mark.parametrize("before", [None, Role.OWNER])
def test_a_page_of_another_site_leads_a_real_browser_in_and_makes_no_owner_a_watcher(
    token_server: TokenServer, browser: playwright.Browser, foreign: str, before: Role | None
) -> None:
    context = browser.new_context(java_script_enabled=False)
    try:
        tab = context.new_page()
        home = f"http://localhost:{token_server.server.get_port()}"
        if before is not None:
            tab.goto(home + link(token_server, before))
            playwright.expect(tab).to_have_url(f"{home}/")
        tab.goto(foreign)
        tab.get_by_text("webviz").click()
        playwright.expect(tab).to_have_url(re.compile(f"^{home}/$"))
        cookies = {f"{each.get('name')}={each.get('value')}" for each in context.cookies()}
        assert token_server.cookie(before or Role.WATCHER) in cookies
    finally:
        context.close()
