"""Links in the terminal: only where nobody keeps what is printed."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path
from types import SimpleNamespace

import psutil
import pytest

from webviz.api.roles import Role
from webviz.server.access.announcing import Announcement, announced, reachable
from webviz.server.access.tokens import make
from webviz.shell.cli.links import show_links

TOKENS = [make(f"the {role.label}", role, datetime.now(UTC)) for role in Role]


def test_a_log_gets_no_link(capsys: pytest.CaptureFixture[str]) -> None:
    show_links(TOKENS, "http://127.0.0.1:80", "127.0.0.1", ())
    output = capsys.readouterr().out
    assert "Run `webviz token list --links`" in output
    assert not [token for token in TOKENS if token.secret in output]


def test_a_terminal_gets_all_links_and_a_qr_code(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdout.isatty", lambda: True)
    show_links(TOKENS, "http://127.0.0.1:80", "127.0.0.1", ())
    output = capsys.readouterr().out
    for token, parameter in zip(TOKENS, ("watch", "operate", "own"), strict=True):
        assert f"http://127.0.0.1:80/?{parameter}={token.secret}\n" in output
    assert "▀▀▀" in output


def test_links_name_the_machine_as_others_reach_it() -> None:
    url = "https://127.0.0.1:81"
    assert reachable(url, "127.0.0.1", ("robot.local",)) == url
    assert reachable(url, "0.0.0.0", ("robot.local", "b")) == "https://robot.local:81"
    assert reachable(url, "192.0.2.7", ()) == "https://192.0.2.7:81"
    assert reachable(url, "2001:db8::1", ()) == "https://[2001:db8::1]:81"
    assert "0.0.0.0" not in reachable(url, "0.0.0.0", ())


def test_a_link_has_the_first_ipv4_address_of_a_network(monkeypatch: pytest.MonkeyPatch) -> None:
    families = (
        (socket.AF_INET, "127.0.0.1"),
        (socket.AF_PACKET, "02:00:00:00:00:01"),
        (socket.AF_INET6, "fe80::1"),
        (socket.AF_INET, "192.0.2.7"),
    )
    addresses = [SimpleNamespace(family=family, address=text) for family, text in families]
    monkeypatch.setattr(psutil, "net_if_addrs", lambda: {"lo": addresses[:1], "eth": addresses[1:]})
    assert reachable("http://127.0.0.1:81", "0.0.0.0", ()) == "http://192.0.2.7:81"


def test_links_are_for_the_viewers_that_run(tmp_path: Path) -> None:
    assert announced(tmp_path / "viewers") == []
    first, second = (
        Announcement(f"http://robot:{port}", port, tmp_path / "viewers") for port in (81, 80)
    )
    assert announced(tmp_path / "viewers") == ["http://robot:80", "http://robot:81"]
    first.close()
    assert announced(tmp_path / "viewers") == ["http://robot:80"]
    second.close()
    assert announced(tmp_path / "viewers") == []


def test_others_cannot_read_where_viewers_are(tmp_path: Path) -> None:
    old = os.umask(0)
    try:
        viewer = Announcement("http://robot:80", 80, tmp_path / "viewers")
    finally:
        os.umask(old)
    (file,) = (tmp_path / "viewers").iterdir()
    assert [path.stat().st_mode & 0o777 for path in (file.parent, file)] == [0o700, 0o600]
    viewer.close()


def test_invalid_announcements_do_not_hide_other_viewers(tmp_path: Path) -> None:
    viewers = [Announcement(f"http://robot:{port}", port, tmp_path) for port in (80, 81)]
    (odd,) = tmp_path.glob("*-81")
    odd.write_bytes(b"\xff")
    (tmp_path / "folder").mkdir()
    assert announced(tmp_path) == ["http://robot:80"]
    for viewer in viewers:
        viewer.close()


def test_viewers_of_one_user_find_each_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))
    viewer = Announcement("http://robot:80", 80)
    assert announced() == ["http://robot:80"]
    viewer.close()
    assert announced() == []


KILLED = """
import os, signal, sys
from pathlib import Path
from webviz.server.access.announcing import Announcement
kept = Announcement("http://robot:80", 80, Path(sys.argv[1]))
os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_viewer_whose_announcement_cannot_be_written_reports_it_and_continues(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    (tmp_path / "viewers").write_text("")
    Announcement("http://robot:80", 80, tmp_path / "viewers").close()
    assert caplog.messages == ["`webviz token` does not know this viewer: File exists."]


def test_a_viewer_that_was_killed_has_no_links(tmp_path: Path) -> None:
    subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], timeout=120, check=False)
    assert len([*tmp_path.iterdir()]) == 1
    assert announced(tmp_path) == []
    assert [*tmp_path.iterdir()] == []
