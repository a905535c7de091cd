"""Only trusted proxies are believed what they say of a request."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from websockets.datastructures import Headers

import webviz
from webviz.server.access.proxies import Caller, Proxies

TRUSTED = Proxies(["127.0.0.1", "10.0.0.0/8", "fd00::/8"])
FORWARDED = {
    "Host": "127.0.0.1:8080",
    "X-Forwarded-For": "203.0.113.7",
    "X-Forwarded-Host": "robot.example",
    "X-Forwarded-Proto": "https",
}


def caller(peer: str, proxies: Proxies = TRUSTED, **headers: str) -> Caller:
    values = {**FORWARDED, **{name.replace("_", "-"): value for name, value in headers.items()}}
    return proxies.caller(peer, Headers(values), is_secure=False)


@pytest.mark.parametrize("peer", ["127.0.0.1", "::ffff:127.0.0.1", "10.1.2.3", "fd00::1"])
def test_headers_of_a_trusted_proxy_give_the_caller(peer: str) -> None:
    assert caller(peer) == Caller("203.0.113.7", ("robot.example",), True)


@pytest.mark.parametrize("peer", ["192.0.2.1", "::1", "127.0.0.2"])
def test_headers_of_other_peers_are_ignored(peer: str) -> None:
    assert caller(peer) == Caller(peer, ("127.0.0.1:8080",), False)
    assert caller("127.0.0.1", Proxies()).address == "127.0.0.1"
    assert caller("::ffff:192.0.2.1").address == "192.0.2.1"
    assert caller("").address == ""  # of a socket that is gone


@pytest.mark.parametrize(
    ("chain", "expected"),
    [
        ("6.6.6.6, 203.0.113.7", "203.0.113.7"),  # the first one is said by the browser itself
        ("203.0.113.7, 10.0.0.9", "203.0.113.7"),
        ("10.0.0.8, 10.0.0.9", "10.0.0.8"),
        ("203.0.113.7:4711", "203.0.113.7"),
        ("[2001:db8::1]:4711", "2001:db8::1"),
        ("2001:db8::1", "2001:db8::1"),
        ("unknown", "127.0.0.1"),
        ("203.0.113.7, unknown", "127.0.0.1"),
        (" , ,", "127.0.0.1"),
    ],
)
def test_the_address_is_the_last_one_that_no_trusted_proxy_has(chain: str, expected: str) -> None:
    assert caller("127.0.0.1", X_Forwarded_For=chain).address == expected


@given(st.text("0129af.:,[]%/ x", max_size=60).map(str.strip))
def test_any_text_has_an_address(text: str) -> None:
    assert caller("127.0.0.1", X_Forwarded_For=text).address


def test_https_is_believed_only_if_all_proxies_say_so() -> None:
    assert not caller("127.0.0.1", X_Forwarded_Proto="https, http").is_secure
    assert not caller("127.0.0.1", X_Forwarded_Proto="ftp").is_secure


@pytest.mark.parametrize("address", ["", "proxy", "10.0.0.0/33", "1.2.3"])
def test_an_invalid_address_is_an_error_in_words(address: str) -> None:
    with pytest.raises(webviz.Error, match=r"^--trust-proxy .* is not an IP address or network, "):
        Proxies([address])
