"""The panel "Doctor", the badge of the toolbar, and findings on the timeline."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.page.conftest import Tab
from webviz import Finding, HideDisplays, OtherFixedFrame, Severity, Symptom, TryYaw
from webviz.api.status import Level, Status
from webviz.commands import Seek, SetFixedFrame, SetProperty, TryFrame
from webviz.engine.state import Row
from webviz.features.doctor.findings import findings_store
from webviz.features.latency.stages import BrowserLatency, Latency, Stage
from webviz.features.what_if import WhatIfStore
from webviz_displays.grid import Grid

EXAMINED_NS = 3_607_000_000_000
HOSTILE = "<img src=x onerror=alert(1)>"
MISSPELT = Finding(
    id="TF002",
    cause='The fixed frame "mapp" does not exist, but "map" does.',
    remedy='Use "map" as the fixed frame.',
    severity=Severity.ERROR,
    command="ros2 run tf2_tools view_frames",
    button=OtherFixedFrame("map"),
    explains=(Symptom("", "Fixed Frame"), Symptom("1", "Transform")),
    proof="It is not one of 2 frames.",
    evidence={"fixed_frame": "mapp", "known": ("map", "odom")},
    began_s=100.0,
    first_ns=3_600_000_000_000,
)
NOTE = Finding(
    id="NET005",
    cause=f"{HOSTILE} takes packets of 1400 bytes.",
    remedy="Check the path.",
    subject="eth0",
    severity=Severity.NOTE,
)


def severe(page: Page) -> Locator:
    """The findings above a note."""
    return page.locator(".wv-doctor > .wv-findings > .wv-finding")


@pytest.fixture
def panel(tab: Tab) -> Iterator[Tab]:
    """The tab with the panel open."""
    tab.page.keyboard.press("Control+k")
    tab.page.keyboard.type("Doctor")
    tab.page.keyboard.press("Enter")
    tab.turn()
    yield tab
    tab.loop.change(findings=(), examined_ns=0)
    tab.turn()
    tab.show_tab("Displays")


def show(tab: Tab, *found: Finding) -> None:
    late = Status(Level.WARN, "No transform.")
    row = Row("1", "Grid", Grid(name="Scan"), "Scan", {"Transform": late, "Points": late})
    well = Row("2", "Grid", Grid(name="Ground"), "Ground", {})
    unknown = {"Fixed Frame": Status(Level.ERROR, "Unknown.")}
    tab.loop.show(well, row, findings=found, statuses=unknown, examined_ns=EXAMINED_NS)
    tab.turn()


def test_findings_have_causes_remedies_and_what_they_explain(panel: Tab) -> None:
    page = panel.page
    expect(page.get_by_text("The doctor examines the viewer.")).to_be_visible()
    show(panel)
    expect(page.get_by_text("All is well")).to_be_visible()
    show(panel, MISSPELT, NOTE)
    expect(page.locator(".wv-finding-examined")).to_have_text("As of 1:00:07.")
    expect(severe(page)).to_have_count(1)
    first = severe(page).first
    cause = 'The fixed frame "mapp" does not exist, but "map" does.'
    expect(first.locator("p").nth(1)).to_have_text(cause)
    expect(first).to_contain_text("It is not one of 2 frames.")
    expect(first).to_contain_text("Seen in Fixed Frame, Scan.")
    expect(first.locator("code").first).to_have_text("ros2 run tf2_tools view_frames")
    first.get_by_role("button", name="Go to 0:01:40").click()
    panel.wait_for(lambda: panel.loop.commands[-1:] == [Seek(100.0)])
    first.get_by_role("button", name="Why, and how to repair it").click()
    expect(first.get_by_text("Everything is drawn in the fixed frame")).to_be_visible()
    expect(first).to_contain_text("Measured: fixed frame mapp; known map, odom.")
    expect(first).to_contain_text("Check TF002, since 1:00:00.")
    first.get_by_role("button", name="Use map").click()
    panel.wait_for(lambda: panel.loop.commands[-1:] == [SetFixedFrame("map")])
    show(panel)
    expect(page.get_by_text("All is well")).to_be_visible()


def test_while_a_frame_is_tried_it_says_so_and_not_that_all_is_well(panel: Tab) -> None:
    page = panel.page
    show(panel)
    expect(page.get_by_text("All is well")).to_be_visible()
    tried = WhatIfStore("laser", "base_link", (0.0,) * 6, (), "", "", None)
    panel.loop.show(what_if=tried)
    panel.turn()
    expect(page.get_by_text("A trial is on: laser is moved")).to_be_visible()
    expect(page.get_by_text("No check finds a problem in this trial.")).to_be_visible()
    expect(page.get_by_text("All is well")).to_be_hidden()
    panel.loop.show(what_if=None)
    panel.turn()
    expect(page.get_by_text("All is well")).to_be_visible()
    expect(page.get_by_text("A trial is on")).to_be_hidden()


def test_the_badge_counts_what_is_more_than_a_note(panel: Tab) -> None:
    page = panel.page
    panel.show_tab("Displays")
    badge = page.locator(".wv-doctor-badge")
    show(panel, NOTE)
    expect(badge).to_be_hidden()
    show(panel, MISSPELT, NOTE)
    expect(badge).to_have_accessible_name("Doctor: 1 finding")
    badge.click()
    expect(severe(page)).to_have_count(1)


def test_notes_are_folded(panel: Tab) -> None:
    page = panel.page
    show(panel, NOTE)
    expect(page.get_by_text("All is well")).to_be_visible()
    notes = page.get_by_role("list", name="Notes")
    expect(notes).to_have_count(0)
    page.get_by_role("button", name="1 note").click()
    expect(notes.locator(".wv-finding")).to_contain_text(HOSTILE)
    page.get_by_role("button", name="1 note").click()
    expect(notes).to_be_hidden()
    show(panel, NOTE, replace(NOTE, subject="eth1"))
    expect(page.get_by_role("button", name="2 notes")).to_be_visible()


def test_a_finding_shows_what_it_found_and_hides_what_draws_nothing(panel: Tab) -> None:
    page = panel.page
    turned = replace(NOTE, severity=Severity.WARNING, button=TryYaw("laser", -0.3))
    show(panel, turned)
    page.get_by_role("button", name="Show me").click()
    panel.wait_for(lambda: panel.loop.commands[-1:] == [TryFrame("laser", -0.3)])
    lacks = replace(turned, subject="bag", button=HideDisplays(("1", "2")))
    show(panel, lacks)
    page.get_by_role("button", name="Hide both").click()
    hidden = [SetProperty(id, "enabled", False) for id in ("1", "2")]
    panel.wait_for(lambda: panel.loop.commands[-2:] == hidden)
    first, second = panel.loop.senders[-2:]
    assert first.step == second.step != 0


def test_a_cause_behind_several_displays_stands_above_them_once(panel: Tab) -> None:
    page = panel.page
    panel.show_tab("Displays")
    show(panel, MISSPELT, NOTE)
    causes = page.locator(".wv-causes > .wv-finding")
    expect(causes).to_have_count(1)
    expect(causes).to_contain_text("It is not one of 2 frames.")
    scan = page.get_by_role("treeitem", name="Scan")
    expect(scan.locator(".wv-tree-status")).to_be_hidden()
    expect(scan).to_have_attribute("aria-description", MISSPELT.cause)
    causes.get_by_role("button", name="Use map").click()
    panel.wait_for(lambda: panel.loop.commands[-1:] == [SetFixedFrame("map")])
    causes.get_by_role("button", name="Why?").click()
    expect(severe(page).first).to_be_focused()
    panel.show_tab("Displays")
    own = replace(NOTE, severity=Severity.WARNING, explains=(Symptom("1", "Transform"),))
    show(panel, own)
    expect(causes).to_have_count(0)
    expect(scan.locator(".wv-tree-status")).to_have_text(own.cause)
    shared = [replace(MISSPELT, subject=str(number)) for number in range(4)]
    show(panel, *shared)
    expect(causes).to_have_count(2)
    page.get_by_role("button", name="2 more causes").click()
    expect(severe(page)).to_have_count(4)


def test_statuses_lead_to_the_finding_that_explains_them_and_back(panel: Tab) -> None:
    page = panel.page
    panel.show_tab("Displays")
    other = replace(NOTE, severity=Severity.ERROR, explains=(Symptom("1", "Points"),))
    own = replace(MISSPELT, explains=(Symptom("1", "Transform"),), button=None)
    show(panel, other, own)
    scan = page.get_by_role("treeitem", name="Scan")
    link = scan.get_by_role("button", name=f"Why? {MISSPELT.cause}")
    expect(link).to_be_visible()
    scan.get_by_role("button", name="Unfold Scan").click()
    lines = page.locator(".wv-statuses-lines > li")
    panel.wait_for(lambda: lines.count() == 2)
    expect(lines).to_have_text(["Transform: No transform.Why?", "Points: No transform.Why?"])
    lines.first.get_by_role("button").click()
    led = severe(page).nth(1)
    expect(led).to_be_focused()
    expect(severe(page).first).to_contain_text(f"Fix this first:{HOSTILE}")
    led.get_by_role("button", name="Scan").click()
    expect(scan).to_have_attribute("aria-selected", "true")
    show(panel)
    expect(page.locator(".wv-finding-link")).to_have_count(0)
    scan.get_by_role("button", name="Fold Scan").click()


def test_a_finding_without_a_check_has_no_documentation() -> None:
    (told,) = findings_store((replace(NOTE, id="DATA999"),), {}, 0.0, 0).all
    assert (told.why, told.level, told.button) == ((), "ok", None)


def test_latencies_are_a_waterfall_that_is_measured_while_it_is_open(panel: Tab) -> None:
    stages = (Stage("received", 0.0, 0.002, 0.004), Stage("ready", 0.002, 0.031, 0.06))
    painted = Stage("acknowledged", 0.0, 0.017, 0.02), Stage("painted", 0.017, 0.05, 0.06)
    to = BrowserLatency(7, HOSTILE, painted, 0.1, 0.2, 34_400.0)
    result = Latency(
        "3", HOSTILE, 40, stages, 0.033, 0.064, f"Waits 31 ms for {HOSTILE}.", 0.0123, (to,)
    )
    scan = Row("3", "Grid", Grid(name=HOSTILE), HOSTILE, {})
    section = panel.page.locator(".wv-latency")
    section.get_by_text("Stamp to screen").click()
    panel.wait_for(lambda: "latency" in panel.loop.watched)
    panel.wait_for(lambda: "No display has drawn a message" in section.inner_text())
    panel.loop.show(scan, latencies=(result,))
    panel.wait_for(lambda: "33 ms, p99 64 ms" in section.inner_text())
    text = section.inner_text()
    takes = f"Takes 1.2 % of a core, 34.4 kB/s to {HOSTILE}."
    assert f"Waits 31 ms for {HOSTILE}. {takes}" in text
    assert "100 ms, p99 200 ms" in text
    assert section.locator("img").count() == 0
    widths = section.locator(".wv-waterfall-bar").evaluate_all(
        "bars => bars.map((bar) => Math.round(parseFloat(bar.style.width)))"
    )
    assert widths == [2, 31, 17, 50]
    section.get_by_text("Stamp to screen").click()
    panel.wait_for(lambda: "latency" not in panel.loop.watched)
    panel.loop.show(latencies=())
