"""The steps of a request, each by itself, without a socket."""

from __future__ import annotations

import gzip
from http import HTTPStatus

import pytest
from websockets.datastructures import Headers
from websockets.http11 import Request, Response

from webviz.server.access.access import Access
from webviz.server.access.proxies import Proxies
from webviz.server.channel.modules import CHANNEL, Modules
from webviz.server.http.hosts import HostList
from webviz.server.http.steps import RequestContext, answer_of, at, behind, page, with_link, within

PAGE = b"<html><head><script>(async()=>{  const d=document.currentScript.dataset;"
SOCKET = {"Upgrade": "websocket"}


def context_of(path: str = "/", peer: str = "10.0.0.1", **headers: str) -> RequestContext:
    values = {"Host": "localhost:1", **{k.replace("_", "-"): v for k, v in headers.items()}}
    return RequestContext(Request(path, Headers(values)), fetched, peer)


def fetched(request: Request) -> Response | None:
    """viser's page; it would pack it by itself if it knew that the browser can unpack."""
    assert "Accept-Encoding" not in request.headers
    return Response(200, "OK", Headers(ETag="1"), PAGE)


class FullServer:
    """No room for anybody."""

    def absence(self, client: RequestContext, /) -> str:
        return "Wait." if client.address == "192.0.2.1" else ""

    def refusal(self, client: RequestContext, /) -> str:
        return "No room."


def test_headers_of_a_trusted_proxy_give_address_and_host() -> None:
    context = context_of(peer="10.0.0.1", X_Forwarded_For="192.0.2.7", X_Forwarded_Host="robot")
    assert behind(Proxies(["10.0.0.1"]))(context) is None
    assert (context.address, context.hosts) == ("192.0.2.7", ("robot",))


@pytest.mark.parametrize(
    ("host", "origin", "status"),
    [
        ("LOCALHOST:1", "http://localhost:1", None),
        ("evil.example", "http://evil.example", HTTPStatus.FORBIDDEN),
        ("localhost:1", "http://evil.example", HTTPStatus.FORBIDDEN),
    ],
)
def test_only_pages_of_this_server_under_its_names_pass(
    host: str, origin: str, status: HTTPStatus | None
) -> None:
    context = context_of(Origin=origin)
    context.hosts = [host]
    reply = at(HostList("127.0.0.1"))(context)
    assert (reply and reply.status) == status
    assert context.host == ("" if status else "localhost:1")


def test_a_visit_without_a_link_gets_a_page_and_no_grant() -> None:
    reply = with_link(Access(True), 1)(context_of())
    assert reply is not None
    assert (reply.status, reply.headers["Cache-Control"]) == (HTTPStatus.FORBIDDEN, "no-store")
    assert b"<h1>webviz</h1>" in reply.body


def test_a_channel_needs_no_room_besides_that_of_its_page() -> None:
    step = within(FullServer())
    for context in (context_of(), context_of(**SOCKET)):
        reply = step(context)
        assert reply is not None
        assert (reply.status, reply.body) == (HTTPStatus.SERVICE_UNAVAILABLE, b"No room.\n")
    assert step(context_of(CHANNEL, **SOCKET)) is None


def test_a_visitor_in_back_off_is_refused_pages_and_channels() -> None:
    step = within(FullServer())
    for context in (context_of(), context_of(**SOCKET), context_of(CHANNEL, **SOCKET)):
        context.address = "192.0.2.1"
        reply = step(context)
        assert reply is not None
        assert (reply.status, reply.body) == (HTTPStatus.TOO_MANY_REQUESTS, b"Wait.\n")


def test_the_page_is_the_only_file_and_packed_for_those_that_unpack_it() -> None:
    modules = Modules({})
    step = page(modules)
    plain, packed = step(context_of()), step(context_of("/index.html?a", Accept_Encoding="gzip"))
    assert plain is not None
    assert packed is not None
    before, after = PAGE.split(b"<head>")
    waiting = after.replace(b"dataset;", b"dataset;await window.webvizModules;")
    assert plain.body == before + b"<head>" + modules.head + waiting
    assert gzip.decompress(packed.body) == plain.body
    assert "Content-Encoding" not in plain.headers
    assert (packed.headers["Content-Encoding"], packed.headers["ETag"]) == ("gzip", "1")
    missing = step(context_of("/etc/passwd"))
    assert missing is not None
    assert missing.status == HTTPStatus.NOT_FOUND
    assert step(context_of(**SOCKET)) is None


def test_the_first_step_with_an_answer_ends_the_row() -> None:
    context = context_of(peer="10.0.0.1", Host="evil.example")
    row = (behind(Proxies()), at(HostList("127.0.0.1")), with_link(Access(True), 1))
    reply = answer_of(row, context)
    assert reply is not None
    assert b"'evil.example' is not allowed" in reply.body
    assert answer_of((behind(Proxies()), at(HostList("127.0.0.1"))), context_of()) is None
