"""Entry: people and their roles, and what happens to those who may not or may no longer."""

from __future__ import annotations

import contextlib
import logging
import time
from datetime import UTC, datetime, timedelta
from typing import get_origin

import msgspec
import pytest
import websockets.exceptions
import websockets.sync.client
from waiting import until
from websockets.exceptions import ConnectionClosed
from websockets.frames import Frame, Opcode

from tests.scene.conftest import Peer
from tests.server.access.conftest import PATIENCE_S, TokenServer
from tests.support.guest import Guest
from webviz.api.roles import Role
from webviz.commands import DragHandle, UseTool
from webviz.engine.commands import Command
from webviz.features.selection import MAX_SELECTED
from webviz.page.dispatcher import NOT_OF_PAGES
from webviz.scene import open_server
from webviz.scene.browsers import HasPainted, Vitals
from webviz.server.access import roles, rules, token_file
from webviz.server.access.access import Access
from webviz.server.access.roles import LIMITS, LINKS, Limits
from webviz.server.access.tokens import make
from webviz.server.channel.refusals import HALF
from webviz.server.http import connections
from webviz.server.http.connections import BURST_S, FLOODED
from webviz.server.http.rate_limits import RateLimit

PARAMETERS = {role: name for name, role in LINKS.items()}


@pytest.mark.parametrize(
    "path", ["/", "/index.html", "/webviz/main.js", "/webviz/constants.js", "/shared", "/x"]
)
@pytest.mark.parametrize("method", ["GET", "HEAD"])
def test_without_a_cookie_there_is_nothing_but_a_sentence(
    token_server: TokenServer, path: str, method: str
) -> None:
    for cookie in ("", "webviz_1=x", f"webviz_{token_server.server.get_port()}={'x' * 64}"):
        response = token_server.ask(path, method, Cookie=cookie)
        assert response.status == 403
        assert b"viser" not in token_server.body
        assert (b"requires a link" in token_server.body) == (method == "GET")


@pytest.mark.parametrize("role", list(Role))
def test_a_link_lets_in_and_is_gone_from_the_address(token_server: TokenServer, role: Role) -> None:
    secret = token_server.tokens[role].secret
    response = token_server.ask(f"/?{PARAMETERS[role]}={secret}&fixedDpr=1", Sec_Fetch_Site="none")
    assert (response.status, response.headers["Location"]) == (303, "./?fixedDpr=1")
    assert response.headers["Referrer-Policy"] == "no-referrer"
    assert response.headers["Cache-Control"] == "no-store"
    cookie = response.headers["Set-Cookie"]
    assert "HttpOnly; SameSite=Strict" in cookie
    assert secret not in f"{response.headers}{token_server.body}"
    value = cookie.partition(";")[0]
    assert token_server.ask("/", Cookie=value).status == 200
    assert secret.encode() not in token_server.body
    assert token_server.tokens[role].cookie.encode() not in token_server.body


@pytest.mark.parametrize("role", list(Role))
def test_a_shared_file_is_only_for_owners(token_server: TokenServer, role: Role) -> None:
    cookie = token_server.cookie(role)
    is_owner = role is Role.OWNER
    assert token_server.ask("/shared", Cookie=cookie).status == (404 if is_owner else 403)
    token_server.server.shared.offer("run.html", b"<p>the run</p>")
    response = token_server.ask("/shared", Cookie=cookie)
    token_server.server.shared.offer("", b"")
    assert response.status == (200 if is_owner else 403)
    assert (b"the run" in token_server.body) == is_owner
    if is_owner:
        assert response.headers["Content-Disposition"] == 'attachment; filename="run.html"'


@pytest.mark.parametrize("query", ["watch=", "own=SECRET", "watch=SECRET&own=SECRET", "watch=x"])
def test_a_wrong_link_is_refused_also_with_a_valid_cookie(
    token_server: TokenServer, query: str
) -> None:
    path = "/?" + query.replace("SECRET", token_server.tokens[Role.WATCHER].secret)
    response = token_server.ask(path, Cookie=token_server.cookie(Role.OWNER))
    assert response.status == 403
    assert "Set-Cookie" not in response.headers
    assert b"This link is not valid" in token_server.body


def test_a_token_in_the_address_of_a_file_grants_nothing(token_server: TokenServer) -> None:
    response = token_server.ask(f"/webviz/main.js?watch={token_server.tokens[Role.WATCHER].secret}")
    assert response.status == 403


def test_another_site_or_name_gets_no_cookie(token_server: TokenServer) -> None:
    path = f"/?own={token_server.tokens[Role.OWNER].secret}"
    for headers in ({"Host": "evil.example"}, {"Origin": "http://evil.example"}):
        response = token_server.ask(path, **headers)
        assert response.status == 403
        assert "Set-Cookie" not in response.headers
        assert (
            token_server.ask("/", Cookie=token_server.cookie(Role.OWNER), **headers).status == 403
        )


def test_large_cookies_are_refused_and_the_server_goes_on(token_server: TokenServer) -> None:
    with pytest.raises((ConnectionError, AssertionError)):
        assert token_server.ask("/", Cookie="a=" + "x" * (1 << 20)).status == 200
    for cookie in (
        "; ".join(["a=b"] * 2000),
        "\xff\xfe=\xff",
        f"{token_server.cookie(Role.OWNER)}\x7f",
    ):
        assert token_server.ask("/", Cookie=cookie).status in (400, 403)
    assert token_server.ask("/", Cookie=token_server.cookie(Role.OWNER)).status == 200


@pytest.mark.parametrize("path", ["/", "/webviz/channel", "/?own=SECRET"])
def test_a_websocket_needs_a_cookie(token_server: TokenServer, path: str) -> None:
    url = f"ws://127.0.0.1:{token_server.server.get_port()}{path}"
    url = url.replace("SECRET", token_server.tokens[Role.OWNER].secret)
    with pytest.raises(websockets.exceptions.InvalidStatus) as excinfo:
        websockets.sync.client.connect(url, additional_headers={"Cookie": "webviz_1=x"})
    assert excinfo.value.response.status_code in (200, 403)


@pytest.mark.parametrize("role", list(Role))
def test_messages_of_a_page_are_checked_against_its_role(
    token_server: TokenServer, role: Role
) -> None:
    guest = token_server.enter(role)
    assert guest.receive("Identity") == {
        "type": "Identity",
        "role": role.label,
        "name": f"some {role.label}",
    }
    for command, required in rules.commands().items():
        if command in SILENT and role >= required:
            guest.send(
                "CommandRequest",
                number=5,
                command=command.__name__,
                arguments=FIELDS[command.__name__],
            )
            continue
        answer = guest.do(command.__name__, **some_fields(command))
        assert answer.startswith("Not allowed: ") == (role < required), (command, answer)
    guest.send("Drive", tool="t", beat=0, linear=1, lateral=0, angular=0)
    problem = guest.receive("DrivingReport")["problem"]
    assert problem.startswith("Not allowed: ") == (role is Role.WATCHER)
    allowed = {c.__name__ for c, required in rules.commands().items() if role >= required}
    allowed -= SERVED
    acted = {"Drive"} if role > Role.WATCHER else set()
    internal = {"InspectTopics", "InspectSelections", "InspectTransforms"}
    assert {*token_server.reached} - internal == allowed | acted


def test_only_operators_say_how_their_page_draws(token_server: TokenServer) -> None:
    reports: list[str | int] = []
    token_server.server.channel.on(Vitals, lambda _, report: reports.append(report.renderer))
    token_server.server.channel.on(HasPainted, lambda _, answer: reports.append(answer.probe))
    right = {"is_software": False, "is_hidden": False, "frame_s": 0.1, "late_s": 0.0}
    for role in Role:
        guest = token_server.enter(role)
        guest.send("Vitals", renderer=role.label, **right)
        guest.send("HasPainted", probe=role.value, waited_s=0.1)
        guest.send("Vitals", renderer="x" * 201, **right)
        guest.send("Vitals", renderer="late", **(right | {"late_s": 1e9}))
        guest.send("HasPainted", probe=9, waited_s=-1.0)
        guest.do("Refresh")  # answered once all of these were read
    assert reports == ["operator", Role.OPERATOR.value, "owner", Role.OWNER.value]


SILENT = (DragHandle, UseTool)
"""Commands of which only refusals and what tools say are answered."""
SERVED = {
    *("Allow", "AskOwner", "BeginUpload", "Decline", "Dismiss", "Forbid", "Invite", "ReadOutput"),
    *("Revoke", "UploadPart", "UseWidget"),
}
"""Commands that the server does itself."""

FIELDS: dict[str, dict[str, object]] = {
    "Allow": {"name": "/calibrate"},
    "AskOwner": {"name": "/calibrate"},
    "DragHandle": {"display": "d", "drag": {"handle": "h", "control": 0, "kind": "press"}},
    "Identify": {"picks": {"group": "g", "key": "k", "items": []}},
    "Invite": {"name": "Ada", "role": "watcher", "days": None, "url": "http://a"},
    "SetBackground": {"color": [1, 2, 3]},
    "UseTool": {"tool": "t", "points": [[0, 0, 0]]},
}
"""Fields of commands with fields that are no plain values."""


def some_fields(command: type[Command]) -> dict[str, object]:
    """Values for the fields that a command needs."""
    plain: dict[object, object] = {float: 1.0, int: 1, bool: True, tuple: []}
    kinds = {
        field.name: get_origin(field.type) or field.type
        for field in msgspec.structs.fields(command)
        if field.required and field.name not in NOT_OF_PAGES
    }
    return FIELDS.get(command.__name__) or {n: plain.get(k, "a") for n, k in kinds.items()}


def test_messages_to_viser_are_checked_against_the_role(token_server: TokenServer) -> None:
    guest = token_server.enter(Role.WATCHER)
    control = token_server.server.scene.add_transform_controls("/handle")
    own = {"type": "TransformControlsUpdateMessage", "name": "/handle", "wxyz": [1, 0, 0, 0]}
    guest.viser.send({**own, "position": [9, 9, 9]})
    guest.viser.look(3.0)
    clients = token_server.server.get_clients
    until(lambda: [c.camera.position[0] for c in clients().values()] == [3.0])
    assert control.position.tolist() == [0, 0, 0]
    owner = token_server.enter(Role.OWNER)
    owner.viser.send({**own, "position": [9, 9, 9]})
    until(lambda: control.position.tolist() == [9, 9, 9])


def test_two_roles_at_once_are_not_mixed_up(token_server: TokenServer) -> None:
    watcher, owner = token_server.enter(Role.WATCHER), token_server.enter(Role.OWNER)
    for _ in range(20):
        assert watcher.do("SetFrameRate", hz=1).startswith("Not allowed")
        assert owner.do("SetFrameRate", hz=1) == ""
    assert [v.role for v in token_server.server.channel.visitors().values()] == [
        Role.WATCHER,
        Role.OWNER,
    ]


def test_the_key_of_a_page_gives_no_role(token_server: TokenServer) -> None:
    owner = Peer(token_server.server, Cookie=token_server.cookie(Role.OWNER))
    key = key_in(owner)
    url = f"ws://127.0.0.1:{token_server.server.get_port()}/webviz/channel"
    cookie = {"Cookie": token_server.cookie(Role.WATCHER)}
    with websockets.sync.client.connect(url, additional_headers=cookie) as thief:
        thief.send(msgspec.json.encode({"type": "Hello", "key": key}).decode())
        assert msgspec.json.decode(thief.recv(60))["role"] == "watcher"
    owner.close()


def key_in(peer: Peer) -> str:
    """The key with which a page opens its channel."""
    (source,) = (m["source"] for m in peer.replay() if m["type"] == "RunJavascriptMessage")
    return msgspec.json.decode(source.partition("(")[2].removesuffix(");"))["key"]


def test_a_revoked_token_closes_its_pages_and_no_others(token_server: TokenServer) -> None:
    operator, owner = token_server.enter(Role.OPERATOR), token_server.enter(Role.OWNER)
    operator.receive("Identity")
    token_server.revoke(Role.OPERATOR)
    with pytest.raises(websockets.exceptions.ConnectionClosed):
        operator.receive("None")
    with pytest.raises(websockets.exceptions.ConnectionClosed):
        operator.viser.drain()
    assert owner.do("Pause") == ""
    cookie = token_server.cookie(Role.OPERATOR)
    assert token_server.ask("/", Cookie=cookie).status == 403
    secret = token_server.tokens[Role.OPERATOR].secret
    assert token_server.ask(f"/?operate={secret}", Cookie=cookie).status == 403
    with pytest.raises(websockets.exceptions.InvalidStatus):
        token_server.enter(Role.OPERATOR)
    assert [v.role for v in token_server.server.channel.visitors().values()] == [Role.OWNER]


def test_messages_sent_before_a_token_was_revoked_are_ignored(token_server: TokenServer) -> None:
    operator = token_server.enter(Role.OPERATOR)
    operator.do("Pause")
    token_server.reached.clear()
    token_server.revoke(Role.OPERATOR)
    deadline = time.monotonic() + PATIENCE_S
    with contextlib.suppress(websockets.exceptions.ConnectionClosed):
        while time.monotonic() < deadline:  # far more than is read in the time that is left
            operator.send("CommandRequest", number=1, command="Reset", arguments={})
    assert time.monotonic() < deadline
    count = len(token_server.reached)
    token_server.enter(Role.OWNER).do("Save")  # answered after all that was received before
    assert token_server.reached[count:] == ["Save"]


def test_an_expired_token_closes_its_pages() -> None:
    now = datetime.now(UTC)
    clock = [now]
    token = make("a", Role.WATCHER, now, days=1.0)
    access = Access(True, others=(token,), now=lambda: clock[0])
    server = open_server(port=0, access=access)
    guest = Guest(server, Cookie=f"webviz_{server.get_port()}={token.cookie}")
    try:
        guest.receive("Identity")
        clock[0] = now + timedelta(days=1.0)
        with pytest.raises(websockets.exceptions.ConnectionClosed):
            guest.receive("None")
    finally:
        guest.close()
        server.stop()


def test_an_owner_ends_a_visit(token_server: TokenServer) -> None:
    owner, watcher = token_server.enter(Role.OWNER), token_server.enter(Role.WATCHER)
    browsers = {role: guest.page["browser"] for role, guest in ((1, watcher), (3, owner))}
    for guest in (owner, watcher):
        guest.receive("Identity")
    assert "this needs an owner" in watcher.do("Dismiss", visitor=browsers[3], revokes=True)
    assert "your own page" in owner.do("Dismiss", visitor=browsers[3], revokes=False)
    assert (
        owner.do("Dismiss", visitor=browsers[1], revokes=False) == "Ended a visit of some watcher."
    )
    assert "has disconnected this page" in watcher.receive("Dismissed")["text"]
    with pytest.raises(websockets.exceptions.ConnectionClosed):
        watcher.receive("Identity")
    assert (
        owner.do("Dismiss", visitor=browsers[1], revokes=True) == "This visitor has already left."
    )
    # The link is still valid.
    token_server.enter(Role.WATCHER).receive("Identity")


def test_an_owner_revokes_a_link(token_server: TokenServer) -> None:
    owner, watcher = token_server.enter(Role.OWNER), token_server.enter(Role.WATCHER)
    for guest in (owner, watcher):
        guest.receive("Identity")
    assert (
        owner.do("Dismiss", visitor=watcher.page["browser"], revokes=True)
        == "Revoked the link of some watcher."
    )
    with pytest.raises(websockets.exceptions.ConnectionClosed):
        watcher.receive("Dismissed")
    assert {token.role for token in token_file.read(token_server.path)} == {"operator", "owner"}
    assert token_server.ask("/", Cookie=token_server.cookie(Role.WATCHER)).status == 403


def test_invitations_in_a_burst_are_all_answered(token_server: TokenServer) -> None:
    owner = token_server.enter(Role.OWNER)
    names = [f"guest {number}" for number in range(40)]
    for number, name in enumerate(names):
        fields = {"name": name, "role": "watcher", "days": None, "url": "http://localhost:8080"}
        owner.send("CommandRequest", number=number, command="Invite", arguments=fields)
    answers = [owner.receive("CommandResult") for _ in names]
    assert {answer["number"] for answer in answers} == {*range(len(names))}
    link_names = [names[answer["number"]] for answer in answers if answer["result"]]
    remaining = [token.name for token in token_file.read(token_server.path)]
    assert sorted(link_names) == sorted(name for name in remaining if name in names)
    assert link_names
    refusal = {answer["text"] for answer in answers if not answer["result"]}
    assert refusal <= {
        "Failed: too many at once. Try again later.",
        f"Cannot write {token_server.path}: another program is saving in this folder; try again.",
    }
    assert owner.do("Pause") == ""


@pytest.mark.parametrize("role", list(Role))
def test_a_command_has_the_priority_of_its_role(token_server: TokenServer, role: Role) -> None:
    token_server.enter(role).do("Export")
    assert token_server.priorities[-1] == role


def test_an_owner_revokes_any_link_but_their_own(token_server: TokenServer) -> None:
    owner, watcher = token_server.enter(Role.OWNER), token_server.enter(Role.WATCHER)
    assert "this needs an owner" in watcher.do("Revoke", name="some owner")
    assert "nobody is not in the file of tokens" in owner.do("Revoke", name="nobody")
    assert "this is your own link" in owner.do("Revoke", name="some owner")
    assert owner.do("Revoke", name="some operator") == "Revoked the link of some operator."
    assert {token.role for token in token_file.read(token_server.path)} == {"watcher", "owner"}


def test_watchers_cannot_keep_the_owner_out(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    few = {
        Role.WATCHER: Limits(0.5, 64, 100.0, 1000, 1000, 1000),
        Role.OPERATOR: Limits(0.75, 64, 100.0, 1000, 1000, 1000),
        Role.OWNER: Limits(1.0, 64, 100.0, 1000, 1000, 1000),
    }
    monkeypatch.setattr("webviz.server.http.connections.LIMITS", few)
    monkeypatch.setattr("webviz.server.http.connections.MAX_BROWSERS", 4)
    server = open_server(port=0, access=Access(True, token_server.path))
    small = TokenServer(server, token_server.tokens, token_server.path, token_server.access)
    try:
        for role, count in ((Role.WATCHER, 2), (Role.OPERATOR, 1), (Role.OWNER, 1)):
            for _ in range(count):
                small.enter(role).receive("Identity")
            assert small.ask("/", Cookie=small.cookie(role)).status == 503
            assert b"which is the limit" in small.body
    finally:
        for guest in small.guests:
            guest.close()
        server.stop()


def test_one_address_has_a_limit(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = {**LIMITS, Role.WATCHER: Limits(1.0, 1, 100.0, 1000, 1000, 1000)}
    monkeypatch.setattr("webviz.server.http.connections.LIMITS", one)
    token_server.enter(Role.WATCHER).receive("Identity")
    assert token_server.ask("/", Cookie=token_server.cookie(Role.WATCHER)).status == 503
    assert b"1 browsers of your address" in token_server.body
    assert token_server.ask("/", Cookie=token_server.cookie(Role.OWNER)).status == 200


@pytest.mark.parametrize("role", [Role.WATCHER, Role.OPERATOR])
def test_a_role_has_a_rate_of_messages(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch, role: Role
) -> None:
    slow = {each: msgspec.structs.replace(LIMITS[each], messages_per_second=2.0) for each in Role}
    monkeypatch.setattr("webviz.server.http.connections.LIMITS", {**LIMITS, role: slow[role]})
    guest, owner = token_server.enter(role), token_server.enter(Role.OWNER)

    def seconds(of: Guest) -> float:
        start = time.monotonic()
        for _ in range(8):  # a burst of four is free, less the first message
            assert of.do("Export") == ""
        return time.monotonic() - start

    assert seconds(guest) > 8 / 2.0 - 2.0
    token_server.reached.clear()
    owner_s = seconds(owner)
    assert LIMITS[Role.OWNER].messages_per_second == 200.0
    assert owner_s < 60.0


def test_long_messages_of_watchers_over_their_rate_are_not_read(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "RateLimit", lambda rate, burst: RateLimit(1e-9, burst))
    watcher, owner = token_server.enter(Role.WATCHER), token_server.enter(Role.OWNER)
    lasting = int(BURST_S * LIMITS[Role.WATCHER].messages_per_second) << 10  # bytes
    for _ in range(2):
        watcher.send(
            "CommandRequest",
            number=1,
            command="FocusFrame",
            arguments={"frame": lasting // 2 * "x"},
        )
    watcher.send("CommandRequest", number=1, command="Export", arguments={})
    for _ in range(3):
        owner.do("FocusFrame", frame=lasting // 2 * "x")
    assert owner.do("ResetView") == ""
    assert (token_server.reached.count("Export"), token_server.reached.count("ResetView")) == (0, 1)


def test_messages_that_a_page_leaves_behind_beyond_its_rate_do_nothing(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "RateLimit", lambda rate, burst: RateLimit(20.0, 5.0))
    watcher = token_server.enter(Role.WATCHER)
    for number in range(300):  # 15 s
        watcher.send("CommandRequest", number=number, command="ResetView", arguments={})
    until(lambda: "ResetView" in token_server.reached)
    watcher.drop()
    until(lambda: not token_server.server.channel.browsers())
    assert token_server.reached.count("ResetView") < 300
    assert "ResetView" in token_server.reached


def test_a_page_that_keeps_sending_too_much_is_ended_with_the_reason(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "RateLimit", lambda rate, burst: RateLimit(20.0, 5.0))
    monkeypatch.setattr(connections, "FLOOD_S", 0.2)
    watcher = token_server.enter(Role.WATCHER)
    for number in range(300):
        watcher.send("CommandRequest", number=number, command="ResetView", arguments={})
    with pytest.raises(ConnectionClosed) as ended:
        watcher.receive("Nothing")
    assert ended.value.rcvd is not None
    assert (ended.value.rcvd.code, ended.value.rcvd.reason) == (1008, FLOODED)
    assert token_server.reached.count("ResetView") < 300
    refusal = token_server.ask(
        "/", Cookie=token_server.cookie(Role.WATCHER)
    )  # neither the page nor a channel
    assert (refusal.status, token_server.body) == (429, f"{FLOODED} Try again in 10 s.\n".encode())
    with pytest.raises(websockets.exceptions.InvalidStatus, match="429"):
        token_server.enter(Role.WATCHER)
    assert token_server.enter(Role.OPERATOR).do("ResetView") == ""


def test_a_page_that_floods_with_pings_is_ended_and_has_to_stay_away(
    token_server: TokenServer,
) -> None:
    flood = 1000 * Frame(Opcode.PING, b"x").serialize(mask=True)
    raw = token_server.enter(Role.WATCHER).websocket.socket
    with contextlib.suppress(OSError):
        for _ in range(1000):
            raw.sendall(flood)
        pytest.fail("the server took a million frames")
    assert token_server.ask("/", Cookie=token_server.cookie(Role.WATCHER)).status == 429


def test_a_page_that_connects_again_has_no_new_burst(
    token_server: TokenServer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "RateLimit", lambda rate, burst: RateLimit(1e-9, burst))
    lasting = int(BURST_S * LIMITS[Role.WATCHER].messages_per_second) << 10  # bytes
    much = {"frame": 2 * lasting // 3 * "x"}
    watcher = token_server.enter(Role.WATCHER)
    watcher.do("FocusFrame", **much)
    watcher.close()
    until(lambda: not token_server.server.channel.browsers())
    again, operator = token_server.enter(Role.WATCHER), token_server.enter(Role.OPERATOR)
    again.send("CommandRequest", number=1, command="FocusFrame", arguments=much)
    again.send("CommandRequest", number=2, command="Export", arguments={})
    for _ in range(3):
        assert operator.do("ResetView") == ""
    assert token_server.reached.count("Export") == 0


def test_websockets_do_not_negotiate_compression(
    token_server: TokenServer,
) -> None:
    url = f"ws://127.0.0.1:{token_server.server.get_port()}/webviz/channel"
    headers = {"Cookie": token_server.cookie(Role.WATCHER)}
    with websockets.sync.client.connect(
        url, compression="deflate", additional_headers=headers, close_timeout=0.1
    ) as guest:
        assert guest.protocol.extensions == []


def test_a_message_has_the_size_that_the_role_may_send(token_server: TokenServer) -> None:
    guest = token_server.enter(Role.WATCHER)
    name = "x" * roles.LIMITS[Role.WATCHER].max_characters
    guest.send("CommandRequest", number=1, command="FocusFrame", arguments={"frame": name})
    refusal = guest.receive("CommandResult")
    assert (refusal["number"], refusal["level"]) == (1, "error")
    limit = roles.LIMITS[Role.WATCHER].max_characters
    assert refusal["text"].endswith(f" characters in one message; the limit is {limit}.")
    guest.send("CommandRequest", number=2, command="Export", arguments={})
    assert guest.receive("CommandResult")["number"] == 2


def test_watchers_may_send_a_selection_and_no_lists_that_are_slow_to_read(
    token_server: TokenServer,
) -> None:
    guest = token_server.enter(Role.WATCHER)
    items = [[number, number, [0.5, 0.5, 0.5], [1, 2, 3]] for number in range(MAX_SELECTED)]
    pick = {"group": "a", "key": "b", "items": items}
    assert guest.do("Select", picks=[pick], keep=[], total=MAX_SELECTED) == ""
    refusal = guest.do("ChangeView", key="distance", value=30_000 * [[]])
    assert refusal.startswith("Failed: 60")
    assert refusal.endswith(" values in one message; the limit is 20000.")
    assert token_server.reached == ["Select"]


@pytest.mark.parametrize("path", [r"\ud83d", r"\\\udfff"])
def test_half_a_letter_is_answered(token_server: TokenServer, path: str) -> None:
    owner = token_server.enter(Role.OWNER)
    text = r'{"type":"CommandRequest","number":1,"command":"Save","arguments":{"path":"PATH"}}'
    owner.say(text.replace("PATH", path))
    answered = owner.receive("CommandResult")
    assert (answered["number"], answered["text"]) == (1, HALF)
    assert token_server.reached == []


def test_no_secret_reaches_the_log(
    token_server: TokenServer, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.DEBUG)
    secret = token_server.tokens[Role.OWNER].secret
    token_server.ask(f"/?own={secret}")
    token_server.ask(f"/?watch={secret}")
    token_server.ask(f"/webviz/channel?own={secret}")
    guest = token_server.enter(Role.WATCHER)
    guest.do("Save")
    token_server.revoke(Role.OWNER)
    until(lambda: token_server.ask("/", Cookie=token_server.cookie(Role.OWNER)).status == 403)
    texts = [r.getMessage() for r in caplog.records if r.name != "websockets.client"]
    for token in token_server.tokens.values():
        assert token.secret not in f"{texts}"
        assert token.cookie not in f"{texts}"


def test_a_stopped_server_leaves_no_task(
    token_server: TokenServer, capfd: pytest.CaptureFixture[str]
) -> None:
    token_server.server.stop()
    assert capfd.readouterr().err == ""
