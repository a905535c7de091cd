"""Several viewers of one robot, each on its router, shared out by a proxy."""

from __future__ import annotations

import re
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import playwright.sync_api as playwright
import pytest
from certificates import certificate
from pages import COARSE
from proxies import running
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter

import webviz
from webviz.api.status import Level
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

SECRET = "a-token-for-watchers-behind-a-proxy"
CONFIG = """\
version: 1
fixed_frame: base
displays:
- {type: Path, topic: /path}
"""
PATH = "nav_msgs/msg/Path"
SIZE: Any = {"width": 640, "height": 400}
MOST = 30
"""Browsers, until each viewer has one."""


def test_browsers_are_shared_out_and_stay(
    router: ZenohRouter,
    robot: ZenohRobot,
    browser: playwright.Browser,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    (tmp_path / "path.yaml").write_text(CONFIG)
    poses = [{"pose": {"position": {"x": float(x)}}} for x in range(3)]
    publish = robot.publisher("/path", PATH, is_latched=True)
    publish({"header": {"frame_id": "base"}, "poses": poses})
    with ExitStack() as stack:
        viewers: list[webviz.Viewer] = []
        for _ in range(3):
            monkeypatch.setenv("WEBVIZ_TOKEN_WATCH", SECRET)  # a viewer removes it
            source = ZenohSource(zenoh_address(router.endpoint, {}))
            viewer = webviz.Viewer(
                tmp_path / "path.yaml",
                port=0,
                source=source,
                allow_hosts=["robots.example"],
                trust_proxies=["127.0.0.1"],
            )
            viewers.append(stack.enter_context(viewer))
        ports = [viewer.port for viewer in viewers]
        port = stack.enter_context(running("nginx", tmp_path, ports, certificate(tmp_path)))
        chosen: set[str] = set()
        for _ in range(MOST):
            with browser.new_context(viewport=SIZE, ignore_https_errors=True) as context:
                url = f"https://localhost:{port}/robot1/"
                context.request.get(f"{url}?watch={SECRET}")
                name = viewer_of(context)
                if name in chosen:  # pages take long
                    continue
                context.clear_cookies(name=re.compile("webviz"))  # but not the proxy's
                page = context.new_page()
                page.goto(f"{url}?watch={SECRET}")
                for _ in range(2):
                    page.goto(f"{url}?fixedDpr={COARSE}")
                    page.wait_for_function("window.webviz?.hasView()")
                    assert viewer_of(context) == name
                viewer = viewers["abc".index(name[-1])]
                # Nothing is drawn before a browser is connected.
                until(
                    lambda v=viewer: v["Path"].status.level is Level.OK, lambda v=viewer: v["Path"]
                )
            chosen.add(name)
            if len(chosen) == len(viewers):
                break
        assert chosen == {"viewer_a", "viewer_b", "viewer_c"}


def viewer_of(context: playwright.BrowserContext) -> str:
    """Return the viewer that the proxy has chosen for a browser."""
    (name,) = [c.get("value", "") for c in context.cookies() if c.get("name") == "viewer"]
    assert re.fullmatch("viewer_[abc]", name)
    return name
