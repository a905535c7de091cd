"""`webviz --token` as a user starts it, and `webviz token` beside it."""

from __future__ import annotations

import http.client
import re
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from program import Program

from webviz.shell.cli import main

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")


@pytest.fixture
def token(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., str]:
    """Return the output of `webviz token`, for a user of their own."""
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path))

    def token(*arguments: str, status: int = 0) -> str:
        assert main(["token", *arguments]) == status
        output = capsys.readouterr()
        return output.out + output.err

    return token


def ask(url: str, path: str = "/", cookie: str = "") -> http.client.HTTPResponse:
    connection = http.client.HTTPConnection(url.removeprefix("http://"), timeout=60)
    headers = {"Sec-Fetch-Site": "none", **({"Cookie": cookie} if cookie else {})}
    connection.request("GET", path, headers=headers)
    response = connection.getresponse()
    response.read()
    connection.close()
    return response


def test_tokens_from_first_start_to_revocation(
    start: Callable[..., Program], token: Callable[..., str], tmp_path: Path
) -> None:
    own = {"XDG_CONFIG_HOME": str(tmp_path)}
    viewer = start("webviz", "--token", "--port", "0", env=own)
    url = viewer.url()
    viewer.wait_for("Run `webviz token list --links` in a terminal")
    file = tmp_path / "webviz" / "tokens.json"
    assert file.stat().st_mode & 0o777 == 0o600
    assert ask(url).status == 403
    output = token("make", "Ada", "--role", "operator", "--days", "1", "--url", url)
    assert "▀" in output  # the QR code
    listed = token("list", "--links")
    assert set(re.findall(r"http://[^/]+", listed)) == {url}
    secrets = re.findall(r"\?\w+=(\S+)", listed)
    assert len(secrets) == 4
    assert not [secret for secret in secrets if secret in token("list")]
    (path,) = re.findall(r"/\?operate=\S+", output)

    def enter() -> http.client.HTTPResponse:
        deadline = time.monotonic() + 60.0
        while (response := ask(url, path)).status != 303:
            assert time.monotonic() < deadline
            time.sleep(0.1)
        return response

    cookie = enter().headers["Set-Cookie"].partition(";")[0]
    assert ask(url, cookie=cookie).status == 200
    assert "already" in token("make", "Ada", status=1)
    assert "No token is named 'Ad'" in token("revoke", "Ad", status=1)
    assert token("revoke", "Ada") == "webviz: revoked Ada.\n"
    deadline = time.monotonic() + 60.0
    while ask(url, cookie=cookie).status != 403:
        assert time.monotonic() < deadline
        time.sleep(0.1)
    assert ask(url, path).status == 403
    assert viewer.end() == 0
    for secret in secrets:
        assert secret not in viewer.output()


def test_a_file_that_others_may_read_stops_the_start(
    ros_env: dict[str, str], token: Callable[..., str], tmp_path: Path
) -> None:
    env = {**ros_env, "XDG_CONFIG_HOME": str(tmp_path)}
    token("make", "Ada")
    file = tmp_path / "webviz" / "tokens.json"
    file.chmod(0o644)
    completed = subprocess.run(
        [sys.executable, "-m", "webviz", "--token", "--port", "0"],
        env=env,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert completed.returncode == 1
    assert completed.stderr.startswith(f"webviz: Other users may read or write {file} (mode 0644).")
    assert completed.stderr.count("\n") == 1
