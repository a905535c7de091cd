"""The panel "Doctor", the badge of the toolbar, and findings on the timeline."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from decimal import ROUND_HALF_UP, Decimal
from typing import ClassVar

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.page.everything import named
from tests.page.page_bench import SCAN, PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz import Finding, HideDisplays, OtherFixedFrame, Severity, Symptom, TryYaw
from webviz.api.check import Check
from webviz.api.observation import Observation
from webviz.api.status import Level, Status
from webviz.commands import EndTrial, ReturnToLive, Seek, SetFixedFrame, SetProperty, TryFrame
from webviz.features.doctor.findings import findings_store
from webviz.features.latency.stages import Latency
from webviz.features.what_if import WhatIfFeature
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.laser_scan import LaserScan

HOSTILE = "<img src=x onerror=alert(1)>"
MISSPELT = Finding(
    id="TF002",
    cause='The fixed frame "mapp" does not exist, but "map" does.',
    remedy='Use "map" as the fixed frame.',
    severity=Severity.ERROR,
    command="ros2 run tf2_tools view_frames",
    button=OtherFixedFrame("map"),
    explains=(Symptom("", "Fixed Frame"), Symptom("Scan", "Transform")),
    proof="It is not one of 2 frames.",
    evidence={"fixed_frame": "mapp", "known": ("map", "odom")},
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


class ReportingCheck(Check):
    """The check of these tests: it finds what they say."""

    id = "DATA998"
    found_now: ClassVar[Sequence[Finding]] = ()

    def find(self, observation: Observation) -> Sequence[Finding]:
        return self.found_now


class QuietCheck(Check):
    """A check that finds nothing."""

    id = "DATA999"

    def find(self, observation: Observation) -> Sequence[Finding]:
        return ()


@pytest.fixture
def viewer(
    page_server: PageServer, viewer_tab: ViewerTab, monkeypatch: pytest.MonkeyPatch
) -> PageBench:
    """A viewer in the second hour of a simulation, in which the doctor examines nothing else."""
    checks = ReportingCheck, *[QuietCheck] * 1000  # one per turn, until a test examines
    monkeypatch.setattr("webviz.features.doctor.known_checks", lambda: checks)
    monkeypatch.setattr("webviz.engine.examiner.SLICE_S", -1.0)
    viewer = page_server.begin(is_linked=False)
    viewer.source.now = 3600 * SECOND
    viewer.link("map", "base_link")
    viewer.link("base_link", "laser")
    late = Status(Level.WARN, "No transform.")
    viewer.report(Scan={"Transform": late, "Points": late})
    return viewer


@pytest.fixture
def panel(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with the panel open."""
    viewer_tab.page.keyboard.press("Control+k")
    viewer_tab.page.keyboard.type("Doctor")
    viewer_tab.page.keyboard.press("Enter")
    settle(viewer_tab)
    yield viewer_tab
    viewer_tab.show_tab("Displays")


def show(tab: ViewerTab, *findings: Finding) -> None:
    """Show two displays in a fixed frame that is unknown, and have the doctor find this."""
    viewer = tab.viewer
    if not viewer.rows:
        viewer.show(*named("Ground", "Scan"), fixed_frame="mapp")
    viewer.do(SetFixedFrame("mapp"))
    ReportingCheck.found_now = [with_ids(viewer, each) for each in findings]
    examine(viewer)
    settle(tab)


def settle(tab: ViewerTab) -> None:
    """Let the page have what it has begun to watch: what follows does not turn the loop."""
    tab.catch_up()
    tab.turn()


def with_ids(viewer: PageBench, finding: Finding) -> Finding:
    """Return a finding with the ids of the displays that it names."""
    ids = {row.name: row.id for row in viewer.rows}
    symptoms = (Symptom(ids.get(each.display, ""), each.status) for each in finding.explains)
    return replace(finding, explains=tuple(symptoms))


def examine(viewer: PageBench) -> None:
    """Let the doctor examine twice, after which findings count, behind what is under way."""
    doctor = viewer.viewer.doctor
    doctor.slice_s = math.inf
    until = doctor.rounds + 3
    while doctor.rounds < until:
        viewer.pass_time(1.0)
        viewer.turn()


def test_findings_have_causes_remedies_and_what_they_explain(panel: ViewerTab) -> None:
    page = panel.page
    expect(page.get_by_text("The doctor examines the viewer.")).to_be_visible()
    show(panel)
    expect(page.get_by_text("All is well")).to_be_visible()
    show(panel, MISSPELT, NOTE)
    expect(page.locator(".wv-finding-examined")).to_have_text("As of 1:00:06.")
    expect(severe(page)).to_have_count(1)
    first = severe(page).first
    cause = 'The fixed frame "mapp" does not exist, but "map" does.'
    expect(first.locator("p").nth(1)).to_have_text(cause)
    expect(first).to_contain_text("It is not one of 2 frames.")
    expect(first).to_contain_text("Seen in Fixed Frame, Scan.")
    expect(first.locator("code").first).to_have_text("ros2 run tf2_tools view_frames")
    began_s = panel.viewer.viewer.doctor.findings[0].began_s
    assert began_s is not None
    first.get_by_role("button", name=re.compile(r"Go to [\d:]+")).click()
    panel.wait_for_command(Seek(round(began_s, 3)))
    playback = panel.viewer.states[-1].playback
    assert playback is not None
    assert not playback.is_live
    assert playback.position_s == pytest.approx(began_s, abs=0.01)
    panel.viewer.do(ReturnToLive())
    first.get_by_role("button", name="Why, and how to repair it").click()
    expect(first.get_by_text("Everything is drawn in the fixed frame")).to_be_visible()
    expect(first).to_contain_text("Measured: fixed frame mapp; known map, odom.")
    expect(first).to_contain_text("Check TF002, since 1:00:04.")
    first.get_by_role("button", name="Use map").click()
    panel.wait_for_command(SetFixedFrame("map"))
    assert panel.viewer.settings.fixed_frame == "map"
    show(panel)
    expect(page.get_by_text("All is well")).to_be_visible()


def test_while_a_frame_is_tried_it_says_so_and_not_that_all_is_well(panel: ViewerTab) -> None:
    page = panel.page
    show(panel)
    expect(page.get_by_text("All is well")).to_be_visible()
    panel.viewer.do(TryFrame("laser"))
    settle(panel)
    expect(page.get_by_text('Trial pose active: "What if" has moved laser')).to_be_visible()
    expect(page.get_by_text("No check found a problem with the trial pose.")).to_be_visible()
    expect(page.get_by_text("All is well")).to_be_hidden()
    panel.viewer.do(EndTrial())
    settle(panel)
    expect(page.get_by_text("All is well")).to_be_visible()
    expect(page.get_by_text("Trial pose active")).to_be_hidden()


def test_the_badge_counts_what_is_more_than_a_note(panel: ViewerTab) -> None:
    page = panel.page
    panel.show_tab("Displays")
    badge = page.locator(".wv-doctor-badge")
    show(panel, NOTE)
    expect(badge).to_be_hidden()
    show(panel, MISSPELT, NOTE)
    expect(badge).to_have_accessible_name("Doctor: 1 finding")
    badge.click()
    settle(panel)
    expect(severe(page)).to_have_count(1)


def test_notes_are_folded(panel: ViewerTab) -> None:
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


def test_a_finding_shows_what_it_found_and_hides_what_draws_nothing(panel: ViewerTab) -> None:
    page = panel.page
    turned = replace(NOTE, severity=Severity.WARNING, button=TryYaw("laser", -0.3))
    show(panel, turned)
    viewer = panel.viewer
    page.get_by_role("button", name="Show me").click()
    panel.wait_for_command(TryFrame("laser", -0.3))
    tried = viewer.viewer.get(WhatIfFeature).what_if("")
    assert tried is not None
    assert (tried.frame, tried.pose[-1]) == ("laser", pytest.approx(-0.3))
    viewer.do(EndTrial())
    ids = [row.id for row in viewer.rows]
    lacks = replace(turned, subject="bag", button=HideDisplays(tuple(ids)))
    show(panel, lacks)
    page.get_by_role("button", name="Hide both").click()
    hidden = [SetProperty(id, "enabled", False) for id in ids]
    panel.wait_for(lambda: viewer.commands[-2:] == hidden)
    assert viewer.values("enabled") == [False, False]
    first, second = viewer.senders[-2:]
    assert first.step == second.step != 0


def test_a_cause_behind_several_displays_stands_above_them_once(panel: ViewerTab) -> None:
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
    panel.wait_for_command(SetFixedFrame("map"))
    assert panel.viewer.settings.fixed_frame == "map"
    causes.get_by_role("button", name="Why?").click()
    settle(panel)
    expect(severe(page).first).to_be_focused()
    panel.show_tab("Displays")
    own = replace(NOTE, severity=Severity.WARNING, explains=(Symptom("Scan", "Transform"),))
    show(panel, own)
    expect(causes).to_have_count(0)
    expect(scan.locator(".wv-tree-status")).to_have_text(own.cause)
    shared = [
        replace(MISSPELT, subject=each, explains=(*MISSPELT.explains, Symptom("Scan", each)))
        for each in ("a", "b", "c", "d")
    ]
    show(panel, *shared)
    expect(causes).to_have_count(2)
    page.get_by_role("button", name="2 more causes").click()
    settle(panel)
    expect(severe(page)).to_have_count(4)


def test_statuses_lead_to_the_finding_that_explains_them_and_back(panel: ViewerTab) -> None:
    page = panel.page
    panel.show_tab("Displays")
    other = replace(NOTE, severity=Severity.ERROR, explains=(Symptom("Scan", "Points"),))
    own = replace(MISSPELT, explains=(Symptom("Scan", "Transform"),), button=None)
    show(panel, other, own)
    scan = page.get_by_role("treeitem", name="Scan")
    link = scan.get_by_role("button", name=f"Why? {MISSPELT.cause}")
    expect(link).to_be_visible()
    scan.get_by_role("button", name="Unfold Scan").click()
    lines = page.locator(".wv-statuses-lines > li")
    panel.wait_for(lambda: lines.count() == 2)
    expect(lines).to_have_text(["Transform: No transform.Why?", "Points: No transform.Why?"])
    lines.first.get_by_role("button").click()
    settle(panel)
    led = severe(page).nth(1)
    expect(led).to_be_focused()
    expect(severe(page).first).to_contain_text(f"Fix this first:{HOSTILE}")
    led.get_by_role("button", name="Scan").click()
    settle(panel)
    expect(scan).to_have_attribute("aria-selected", "true")
    show(panel)
    expect(page.locator(".wv-finding-link")).to_have_count(0)
    scan.get_by_role("button", name="Fold Scan").click()


def test_a_finding_without_a_check_has_no_documentation() -> None:
    (entry,) = findings_store((replace(NOTE, id="DATA999"),), {}, 0.0, 0).all
    assert (entry.why, entry.level, entry.button) == ((), "ok", None)


def test_latencies_are_a_waterfall_that_is_measured_while_it_is_open(
    viewer: PageBench, panel: ViewerTab
) -> None:
    viewer.show(LaserScan(name=HOSTILE))
    section = panel.page.locator(".wv-latency")
    section.get_by_text("Stamp to screen").click()
    panel.wait_for(lambda: "No display has drawn a message" in section.inner_text())

    def is_shown() -> bool:
        """Publish a scan 2 ms after its stamp, its transform another 30 ms later, and compare."""
        stamp_ns = viewer.source.now
        viewer.pass_time(0.002)
        viewer.publish("/scan", SCAN, {"header": header(HOSTILE, stamp_ns)})
        viewer.turn()
        panel.page.wait_for_timeout(30)
        viewer.transform("map", HOSTILE, stamp_ns)
        viewer.turn()
        viewer.pass_time(0.1)
        latencies, text = viewer.states[-1].latencies, section.inner_text()
        return any(each.browsers and is_in(each, text) for each in latencies)

    panel.wait_for(is_shown)
    (latency,) = viewer.states[-1].latencies
    (to,) = latency.browsers
    received, ready, *_ = latency.stages
    assert received.p50 == pytest.approx(0.002, abs=1e-4)
    assert ready.p50 > 0.03
    assert latency.waits_for.startswith(f"Waits {1000 * ready.p50:.0f} ms for map to {HOSTILE}")
    assert section.locator("img").count() == 0
    widths = section.locator(".wv-waterfall-bar").evaluate_all(
        "bars => bars.map((bar) => parseFloat(bar.style.width))"
    )
    ends = sum(each.p50 for each in latency.stages), to.stages[1].begin + to.stages[1].p50
    shares = [100 * each.p50 / sum(ends) for each in (*latency.stages, *to.stages)]
    assert widths == pytest.approx(shares, abs=0.5)
    section.get_by_text("Stamp to screen").click()
    panel.wait_for(lambda: viewer.states[-1].latencies == ())


def is_in(latency: Latency, text: str) -> bool:
    """Return whether a text has all numbers of a latency."""
    links = "".join(f", {per_second(to.bytes_per_s)} to {to.name}" for to in latency.browsers)
    ways = [f"{ms(each.p50)}, p99 {ms(each.p99)}" for each in (latency, *latency.browsers)]
    takes = f"{latency.waits_for} Takes {fixed(100 * latency.core, 1)} % of a core{links}."
    return all(each in text for each in (latency.name, *ways, takes))


def ms(seconds: float) -> str:
    value = 1000 * seconds
    return f"{fixed(value, 1 if value < 9.95 else 0)} ms"


def per_second(size: float) -> str:
    return f"{fixed(size, 0)} B/s" if size < 1000 else f"{fixed(size / 1000, 1)} kB/s"


def fixed(value: float, digits: int) -> Decimal:
    """Round as pages do: a half upwards."""
    return Decimal(value).quantize(Decimal(1).scaleb(-digits), ROUND_HALF_UP)
