"""The shown moment as one file: of a bag and of live topics."""

from __future__ import annotations

import base64
import json
import math
import re
import threading
from collections.abc import Callable, Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from bags import START_NS
from drives import CONFIG, recorded
from live_paths import path_viewer, receive_path
from pages import COARSE
from playwright.sync_api import expect
from waiting import until

import webviz
from webviz.commands import ListMoment, Refresh, ShareMoment, StopSharing
from webviz.engine.parts.part import HostProgram
from webviz.features.sharing import SharingState
from webviz.features.sharing.exporting import SharedMoment, export
from webviz.shell.testing.source import HandFedSource

PATH = "nav_msgs/msg/Path"
AT_S = 2.0
PATIENCE_S = 120.0
"""Time in seconds for another process, which imports everything anew."""


@pytest.fixture
def source() -> HandFedSource:
    return HandFedSource()


@pytest.fixture
def live(source: HandFedSource) -> Iterator[webviz.Viewer]:
    """A viewer of live topics that has received some paths."""
    with path_viewer(source, 5) as viewer:
        yield viewer


def shared(viewer: webviz.Viewer, holds: Callable[[SharingState], bool]) -> SharingState:
    def match() -> SharingState | None:
        viewer.do(Refresh())
        state = viewer.state.sharing
        return state if state is not None and holds(state) else None

    return until(match, lambda: f"still {viewer.state.sharing}", seconds=PATIENCE_S, look_s=0.1)


def test_live_topics_are_shared_one_file_at_a_time(live: webviz.Viewer, tmp_path: Path) -> None:
    path = tmp_path / "run.html"
    assert "Making run.html" in live.do(ShareMoment(str(path)))
    with pytest.raises(webviz.Error, match="Another file is being made"):
        live.do(ShareMoment(str(path)))
    state = shared(live, lambda state: state.number == 1)
    assert (state.share, state.level) == (None, webviz.Level.OK)
    assert re.fullmatch(r"Saved run\.html: \d\.\d s, \d\.\d MB\.", state.text)
    assert path.read_bytes().startswith(b"<!doctype html>")
    assert list(tmp_path.iterdir()) == [path]


def test_a_file_that_is_stopped_leaves_nothing(live: webviz.Viewer, tmp_path: Path) -> None:
    live.do(ShareMoment(str(tmp_path / "run.html")))
    assert live.do(StopSharing()) == "Stopped; no file was written."
    assert shared(live, lambda state: state.share is None).number == 0
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(webviz.Error, match="No file is being made"):
        live.do(StopSharing())


def test_a_file_that_cannot_be_written_is_one_sentence(live: webviz.Viewer, tmp_path: Path) -> None:
    live.do(ShareMoment(str(tmp_path / "missing" / "run.html")))
    state = shared(live, lambda state: state.number == 1)
    assert state.level is webviz.Level.ERROR
    assert "No such file or directory. Choose another place." in state.text


def test_without_memory_there_is_nothing_to_share(tmp_path: Path) -> None:
    with webviz.Viewer(port=0, source=HandFedSource()) as viewer:
        viewer.config = {"displays": []}
        with pytest.raises(webviz.Error, match="No messages are kept in memory"):
            viewer.do(ShareMoment(str(tmp_path / "run.html")))


def test_an_export_reports_its_progress(tmp_path: Path) -> None:
    recorded().write(tmp_path / "run")
    (tmp_path / "lab.yaml").write_text(CONFIG)
    (bag,) = (tmp_path / "run").glob("*.mcap")
    path, shares, files = tmp_path / "run.html", list[float](), dict[str, bytes]()
    text = export(
        SharedMoment(bag, tmp_path / "lab.yaml", path, "", AT_S),
        HostProgram(files.__setitem__),
        shares.append,
        threading.Event(),
    )
    assert re.fullmatch(r"6\.0 s, \d\.\d MB\.", text)
    packed = re.search(rb'"webviz/about">([^<]*)<', files["run.html"])
    assert packed is not None
    about = json.loads(base64.b64decode(packed[1]))
    assert about["start"] == pytest.approx(START_NS / 1e9)
    assert about["duration"] == pytest.approx(6.0, abs=0.1)
    assert about["at"] == AT_S
    assert shares == sorted(shares)
    assert 0.5 < shares[-1] <= 1.0
    assert files == {"run.html": path.read_bytes()}


def test_a_click_shares_the_moment_and_the_view(
    browser: playwright.Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    recorded().write(tmp_path / "run")
    (tmp_path / "lab.yaml").write_text(CONFIG)
    (work := tmp_path / "work").mkdir()
    monkeypatch.chdir(work)
    context = browser.new_context(viewport={"width": 1000, "height": 600})
    with webviz.Viewer(tmp_path / "lab.yaml", port=0, bag=tmp_path / "run") as viewer:
        viewer.seek(AT_S)
        page = context.new_page()
        page.goto(f"{viewer.url}/?fixedDpr={COARSE}")
        page.wait_for_function("window.webviz?.hasView()")
        page.get_by_role("button", name="Share this moment").click()
        dialog = page.get_by_role("dialog")
        expect(dialog.get_by_role("listitem").first).to_contain_text(re.compile(r"6\.0 s of \d"))
        with page.expect_download(timeout=PATIENCE_S * 1e3) as downloaded:
            dialog.get_by_role("button", name="Share", exact=True).click()
        expect(page.get_by_text("Saved webviz_run_")).to_be_visible()
        (path,) = work.iterdir()
        assert downloaded.value.suggested_filename == path.name
        assert Path(downloaded.value.path()).read_bytes() == path.read_bytes()
        with page.expect_download() as again:
            page.get_by_role("button", name="Download").click()
        assert again.value.suggested_filename == path.name
    page.goto(f"{path.as_uri()}?fixedDpr={COARSE}")
    page.wait_for_function("window.webviz?.hasView()")
    expect(page.get_by_label("Go to time")).to_have_value(f"0:00:0{AT_S:.3f}")
    expect(page.get_by_role("button", name="Share this moment")).to_be_hidden()
    context.close()


def listed(viewer: webviz.Viewer, **span: float) -> float:
    """The seconds that a file would have."""
    return float(viewer.do(ListMoment(**span)).partition(" ")[0])


def test_the_span_of_a_bag_is_chosen(tmp_path: Path) -> None:
    recorded().write(tmp_path / "run")
    with webviz.Viewer(port=0, bag=tmp_path / "run") as viewer:
        viewer.seek(AT_S)
        assert listed(viewer) == pytest.approx(5.9, abs=0.2)
        assert listed(viewer, before_s=1.0, after_s=0.5) == 1.5
        assert listed(viewer, before_s=100.0, after_s=0.0) == pytest.approx(AT_S, abs=0.1)


def test_the_last_seconds_of_live_topics_are_chosen(
    live: webviz.Viewer, source: HandFedSource
) -> None:
    def remembered() -> bool:
        receive_path(source)
        return listed(live) > 0.9

    until(remembered, look_s=0.05)
    assert listed(live, before_s=0.4, after_s=0.0) <= 0.5


@pytest.mark.parametrize("span", [(0.0, 0.0), (-1.0, 1.0), (math.nan, 1.0), (math.inf, 0.0)])
def test_invalid_spans_are_refused(live: webviz.Viewer, span: tuple[float, float]) -> None:
    for command in (ListMoment, ShareMoment):
        with pytest.raises(webviz.Error, match="This is not a valid time span"):
            live.do(command(before_s=span[0], after_s=span[1]))


def test_a_page_chooses_the_span_and_cancels(
    live: webviz.Viewer,
    browser: playwright.Browser,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    context = browser.new_context(viewport={"width": 1700, "height": 700})
    page = context.new_page()
    page.goto(live.url)
    page.get_by_role("button", name="Share this moment").click()
    dialog = page.get_by_role("dialog")
    expect(dialog.get_by_label("All that is remembered")).to_be_checked()
    dialog.get_by_label("The last 10 s").check()
    dialog.get_by_role("button", name="Cancel").click()
    expect(dialog).to_have_count(0)
    assert list(tmp_path.iterdir()) == []
    page.get_by_role("button", name="Share this moment").click()
    dialog.get_by_role("button", name="Share", exact=True).click()
    expect(page.get_by_text("Sharing…")).to_be_visible()
    expect(dialog).to_have_count(0)
    page.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text("Stopped; no file was written.")).to_be_visible()
    expect(page.get_by_text("Sharing…")).to_be_hidden()
    context.close()
