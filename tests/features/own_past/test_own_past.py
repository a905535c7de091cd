"""A page that looks back on its own: what it may do, who else may come, and how it ends."""

from __future__ import annotations

import stat
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import psutil
import pytest
import websockets.exceptions
from waiting import until

from tests.support.guest import Guest
from tests.support.memory_viewer import PATH, MemoryViewer
from webviz.api.declared import Topic
from webviz.api.roles import Role
from webviz.commands import Seek
from webviz.engine.parts.time import REWOUND
from webviz.features import own_past
from webviz.features.own_past import NOT_HERE
from webviz.shell.app import own_pasts
from webviz.shell.app.own_pasts import MAX_PASTS, TOO_MANY
from webviz.sources import Subscription


def playback(guest: Guest) -> dict[str, Any]:
    guest.send("Watch", store="playback")
    while (values := guest.receive("Values"))["store"] != "playback" or not values["set"]:
        pass
    guest.send("Unwatch", store="playback")
    return values["set"]


def threads() -> int:
    return sum(thread.name == "webviz-own-past" for thread in threading.enumerate())


def test_a_page_looks_back_while_all_others_stay_live(memory: MemoryViewer) -> None:
    page, other = memory.enter(), memory.enter()
    own = memory.enter(below=memory.look_back(page))
    until(lambda: "position" in playback(own))
    past, live = playback(own), playback(other)
    # The past begins with its first message, which a viewer that starts slowly has late.
    expected_s = max(live["start"] + 1.0, past["start"])
    assert past["start"] + past["position"] == pytest.approx(expected_s, abs=0.1)
    assert playback(own)["is_live"] is None
    assert playback(own)["is_playing"] is False
    assert playback(other)["is_live"] is True
    assert own.do("Play") == ""
    assert memory.viewer.fact("playback").is_live is True


def test_the_messages_are_those_of_the_memory(memory: MemoryViewer) -> None:
    """No copies: four pages cost no four memories."""
    from webviz.sources.recording.moment import MomentHistory

    moment = MomentHistory(memory.memory).prepared()
    shared = {id(raw.cdr) for _, raw in memory.memory.entries()}
    channels = moment.channels({"/plan": Subscription(PATH, Topic("/plan"))})
    messages = [*moment.messages(channels, moment.start_ns)]
    assert {id(each.cdr) for each in messages} <= shared
    assert sum(moment.histogram(10)["/plan"]) == len(messages) > 0


def test_nothing_is_sent_saved_or_opened_from_there(make: Callable[..., MemoryViewer]) -> None:
    memory = make(token=True)
    own = memory.enter(below=memory.look_back(memory.enter(Role.OWNER)))
    for command, arguments in {
        "Save": {},
        "SaveMemory": {},
        "ShareMoment": {},
        "Open": {"path": "x.yaml"},
        "Allow": {"name": "/goal_pose"},
        "Invite": {"name": "Eve", "role": "owner", "days": None, "url": "http://x"},
    }.items():
        assert "Not allowed" in own.do(command, **arguments), command
    assert own.do("LookBackAlone", at_s=0.0) == NOT_HERE
    answer = own.do("UseTool", tool="2D Goal Pose", points=[[0, 0, 0]], yaw=0.0)
    assert answer == REWOUND


def test_only_its_own_browser_comes_to_it(make: Callable[..., MemoryViewer]) -> None:
    memory = make(token=True)
    path = memory.look_back(memory.enter(Role.OPERATOR))
    assert memory.status(path, Role.OPERATOR) == 200
    for role in (Role.WATCHER, Role.OWNER):
        assert memory.status(path, role) == 403
        with pytest.raises(websockets.exceptions.InvalidStatus):
            memory.enter(role, below=path)
    assert "Not allowed" in memory.look_back(memory.enter(Role.WATCHER))


@pytest.mark.parametrize("path", ["/past/", "/past/1/", "/past/1", "/past//", "/past/%2e%2e/"])
def test_names_are_not_guessed(memory: MemoryViewer, path: str) -> None:
    memory.look_back(memory.enter())
    assert memory.status(path) == 404
    assert b"Back to live" in memory.body


@pytest.mark.parametrize(
    "below", ["../", "../../", "..%2f..%2fetc/passwd", "etc/passwd", "x/../", "shared", "past/1/"]
)
def test_below_it_there_is_the_page_only(memory: MemoryViewer, below: str) -> None:
    path = memory.look_back(memory.enter())
    assert memory.status(path + below) == 404
    assert memory.status(path) == 200
    assert b"viser" in memory.body
    assert memory.status(path, method="HEAD") == 200
    assert memory.body == b""


def test_there_are_four_and_the_fifth_reads_why_it_cannot(memory: MemoryViewer) -> None:
    pages = [memory.enter() for _ in range(MAX_PASTS + 1)]
    paths = [memory.look_back(page) for page in pages]
    assert paths[MAX_PASTS] == TOO_MANY
    assert len({*paths}) == MAX_PASTS + 1
    assert [memory.status(path) for path in paths[:MAX_PASTS]] == [200] * MAX_PASTS


def test_it_ends_when_its_page_has_gone(
    memory: MemoryViewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(own_past, "ABSENT_S", 1.0)
    path = memory.look_back(memory.enter())
    own = memory.enter(below=path)
    memory.viewer.attend(0.0)
    until(lambda: playback(own))
    assert threads() == 1
    own.close()
    until(lambda: threads() == 0)
    assert memory.status(path) == 404
    assert "/past/" in memory.look_back(memory.enter())


def test_it_ends_if_its_page_never_comes(
    memory: MemoryViewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(own_past, "ABSENT_S", 1.0)
    paths = [memory.look_back(memory.enter()) for _ in range(MAX_PASTS)]
    until(lambda: threads() == 0)
    assert [memory.status(path) for path in paths] == [404] * MAX_PASTS


def test_it_ends_with_the_viewer(make: Callable[..., MemoryViewer]) -> None:
    memory = make()
    own = memory.enter(below=memory.look_back(memory.enter()))
    until(lambda: playback(own))
    memory.close()
    until(lambda: threads() == 0)


def test_a_revoked_link_ends_it(make: Callable[..., MemoryViewer]) -> None:
    memory = make(token=True)
    path = memory.look_back(memory.enter(Role.OPERATOR))
    own = memory.enter(Role.OPERATOR, below=path)
    operator = next(t for t in memory.viewer.access.tokens if t.role == "operator")
    assert "Revoked" in memory.enter(Role.OWNER).do("Revoke", name=operator.name)
    with pytest.raises(websockets.exceptions.ConnectionClosed):
        own.receive("Nothing")
    assert memory.status(path, Role.OPERATOR) == 403


def test_many_at_once_get_four(memory: MemoryViewer) -> None:
    pages = [memory.enter() for _ in range(10)]
    answers: list[str] = []
    asking = [
        threading.Thread(target=lambda page=page: answers.append(memory.look_back(page)))
        for page in pages
    ]
    for thread in asking:
        thread.start()
    for thread in asking:
        thread.join()
    assert sum("/past/" in answer for answer in answers) == MAX_PASTS
    assert answers.count(TOO_MANY) == 10 - MAX_PASTS
    assert memory.viewer.fact("playback").is_live is True


def test_a_failure_to_open_is_reported(
    memory: MemoryViewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(*_: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(own_pasts, "open_behind", fails)
    assert "No space left on device" in memory.look_back(memory.enter())
    until(lambda: threads() == 0)
    monkeypatch.undo()
    assert "/past/" in memory.look_back(memory.enter())


def test_without_a_memory_there_is_nothing_to_look_back_on(
    make: Callable[..., MemoryViewer],
) -> None:
    memory = make()
    memory.viewer.config = {"memory": {"seconds": 0}, "displays": []}
    assert "not remembered" in memory.look_back(memory.enter())


def test_the_browser_that_looks_back_for_everybody_is_named(memory: MemoryViewer) -> None:
    leader, other = memory.enter(), memory.enter()
    leader.do("Seek", at_s=1.0)
    until(lambda: playback(other).get("leader") == leader.page["browser"])
    memory.viewer.do(Seek(0.5))
    until(lambda: playback(other).get("leader") is None)


def test_it_listens_on_no_port(memory: MemoryViewer) -> None:
    process = psutil.Process()
    before = {each.laddr for each in process.net_connections("inet") if each.status == "LISTEN"}
    memory.look_back(memory.enter())
    after = {each.laddr for each in process.net_connections("inet") if each.status == "LISTEN"}
    assert after == before
    sockets = {str(each.laddr) for each in process.net_connections("unix")}
    (socket,) = {Path(path) for path in sockets if "webviz_past_" in path}
    assert stat.S_IMODE(socket.parent.stat().st_mode) == 0o700
