"""Whose right ends: their pages are closed, whatever the disk does."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from datetime import UTC, datetime, timedelta
from pathlib import Path

import msgspec
import pytest
from waiting import until
from websockets.exceptions import ConnectionClosed

from tests.server.access.conftest import TokenServer
from tests.support.guest import Guest
from webviz.api.roles import Role
from webviz.data.disk import MAX_THREADS, in_thread
from webviz.scene import open_server
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.tokens import make


@pytest.fixture
def mounted() -> Iterator[threading.Event]:
    """Yield an event that lets a dead mount, on which threads wait, answer."""
    mounted = threading.Event()
    yield mounted
    mounted.set()


def test_a_link_is_revoked_although_no_thread_is_left_for_the_disk(
    token_server: TokenServer, mounted: threading.Event
) -> None:
    operator = token_server.enter(Role.OPERATOR)
    operator.receive("Identity")
    waiting = [in_thread(mounted.wait) for _ in range(MAX_THREADS)]
    token_server.revoke(Role.OPERATOR)
    with pytest.raises(ConnectionClosed):
        operator.receive("None")
    assert token_server.ask("/", Cookie=token_server.cookie(Role.OPERATOR)).status == 403
    mounted.set()
    assert all(each.result(60.0) for each in waiting)


class Stuck(Access):
    """Reads its file from a dead mount, or fails to."""

    mounted: threading.Event
    fails = False

    def refresh(self) -> None:
        if self.fails:
            raise RuntimeError
        self.mounted.wait()
        super().refresh()


@pytest.mark.parametrize("fails", [False, True])
def test_a_token_expires_although_its_file_cannot_be_read(
    tmp_path: Path,
    mounted: threading.Event,
    fails: bool,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("webviz.server.access.access.MAX_MISSED", 1)
    clock = [datetime.now(UTC)]
    token = make("a", Role.WATCHER, clock[0], days=1.0)
    path = tmp_path / "tokens.json"
    token_file.modify(path, lambda _: [token])
    access = Stuck(True, path, now=lambda: clock[0])
    access.mounted, access.fails = mounted, fails
    server = open_server(port=0, access=access)
    guest = Guest(server, Cookie=f"webviz_{server.get_port()}={token.cookie}")
    try:
        guest.receive("Identity")
        if not fails:
            until(lambda: "the disk of" in caplog.text)
        clock[0] += timedelta(days=1.0)
        with pytest.raises(ConnectionClosed):
            guest.receive("None")
        access.fails = False
        mounted.set()
        other = make("b", Role.WATCHER, clock[0])
        token_file.modify(path, lambda _: [other])
        until(lambda: access.by_cookie(other.cookie))
    finally:
        guest.close()
        server.stop()


def test_a_role_that_is_lowered_in_the_file_closes_its_pages(token_server: TokenServer) -> None:
    owner = token_server.enter(Role.OWNER)
    owner.receive("Identity")
    lowered = msgspec.structs.replace(token_server.tokens[Role.OWNER], role="watcher")
    token_file.modify(token_server.path, lambda _: [lowered])
    with pytest.raises(ConnectionClosed):
        owner.receive("None")
    again = token_server.enter(Role.OWNER)
    assert again.receive("Identity")["role"] == "watcher"


def test_no_right_survives_a_failure_to_read_the_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    token = make("a", Role.WATCHER, datetime.now(UTC))
    path = tmp_path / "tokens.json"
    token_file.modify(path, lambda _: [token])
    access = Access(True, path)
    token_file.modify(path, lambda _: [])
    monkeypatch.setattr(token_file, "read", lambda _: 1 / 0)
    access.refresh()
    assert access.by_cookie(token.cookie) is None
