"""A whole viewer that asks for tokens, and programs that join it as pages do."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from several import several
from waiting import until

import webviz
from tests.support.guest import Guest, Served
from webviz import commands
from webviz.api.roles import Role
from webviz.data.messages import encode, interfaces
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource

TRIGGER = "std_srvs/srv/Trigger"
CALIBRATE = "/calibrate"


class OfferingGraph(RememberingGraph):
    """A graph with a service."""

    def services(self) -> dict[str, str]:
        """Return the services."""
        return {CALIBRATE: TRIGGER}


class TokenViewer:
    """A viewer that asks for tokens and trusts a proxy on this machine."""

    def __init__(self, *, is_read_only: bool = False, **options: Any) -> None:
        response = encode(interfaces.service(TRIGGER).response, {"success": True})
        self.graph = OfferingGraph(responses={CALIBRATE: response})
        source = HandFedSource() if is_read_only else HandFedSource(graph=self.graph)
        self.viewer = webviz.Viewer(port=0, source=source, trust_proxies=["127.0.0.1"], **options)
        self.guests: list[Guest] = []

    def cookie(self, role: Role) -> tuple[str, str]:
        """Return name and value of the cookie of a role."""
        token = next(t for t in self.viewer.access.tokens if t.role == role.label)
        return f"webviz_{self.viewer.port}", token.cookie

    def enter(self, role: Role, address: str = "") -> Guest:
        """Join as a person with a role, from this machine or by the proxy from another address."""
        cookie = "=".join(self.cookie(role))
        forwarded = {"X-Forwarded-For": address} if address else {}
        self.guests.append(Guest(Served(self.viewer.port), Cookie=cookie, **forwarded))
        return self.guests[-1]

    def call(self) -> str:
        """Call the service as a panel does; what went wrong, "" for nothing."""
        failed: list[str] = []
        answered: list[Any] = []
        call = commands.CallService(
            CALIBRATE, TRIGGER, {}, answered=answered.append, failed=failed.append
        )
        self.viewer.do(call)
        until(lambda: failed or answered)
        return "".join(failed)

    def store(self, guest: Guest, name: str) -> dict[str, Any]:
        """Watch a store, and return its first values."""
        guest.send("Watch", store=name)
        while (values := guest.receive("Values"))["store"] != name:
            pass
        guest.send("Unwatch", store=name)
        return values["set"]

    def journal(self) -> list[str]:
        """Return what the owner reads of people, newest first."""
        entries = self.store(self.enter(Role.OWNER), "journal")["entries"]
        return [entry["text"] for entry in entries]

    def allowed(self) -> list[str]:
        """Return what is allowed for this session."""
        return self.store(self.enter(Role.OWNER), "permission_requests")["allowed"]

    def close(self) -> None:
        for guest in self.guests:
            guest.close()
        self.viewer.close()


@pytest.fixture
def make(
    tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch
) -> Iterator[Callable[..., TokenViewer]]:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("config")))
    with several(TokenViewer) as make:
        yield make


@pytest.fixture
def token_viewer(make: Callable[..., TokenViewer]) -> TokenViewer:
    return make()
