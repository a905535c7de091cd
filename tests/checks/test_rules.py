"""Rules: `webviz test`, and findings about those of the config."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from xml.etree import ElementTree

import building
import examining
import pytest
from bags import START_NS, Bag, ns
from examining import HERE, SCAN, look, three_ranges

from webviz.api.finding import CauseLevel
from webviz.api.observation import DisplaySeen, Observation
from webviz.api.rule import parse_rule
from webviz.api.status import Level, Status
from webviz.data.messages import encode
from webviz.data.transforms import TransformBuffer
from webviz.features.doctor.rules import value_of
from webviz.files.config import WatchRule
from webviz.shell.cli import main
from webviz.shell.doctor.rule_results import RuleResults
from webviz.shell.testing.harness import Harness
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_sim.pose import Pose2D

NUMBER = "std_msgs/msg/Float64"


WIDE = Path(__file__).parents[3] / "shared/data/reports/B3w/wstring.mcap"


@pytest.fixture
def run(tmp_path: Path) -> Path:
    """A bag whose scans stop for ten seconds."""
    bag = Bag()
    bag.add("/scan", SCAN)
    bag.add("/charge", NUMBER)
    bag.transform(0.0, "base_link", "laser", static=True)
    for number in range(200):
        at_s = number / 10
        bag.transform(at_s, "odom", "base_link", at_s)
        bag.put(at_s, "/charge", {"data": 0.1 if number == 57 else 1.0})
        if 5.0 < at_s < 15.0:
            continue
        bag.put(at_s, "/scan", three_ranges("laser", START_NS + ns(at_s)))
    return bag.write(tmp_path / "run")


@pytest.mark.parametrize(
    ("text", "subject", "expectation", "seconds"),
    [
        ("Scan.walls > 0.8", "Scan", "> 0.8", 0.0),
        ("Front Scan v1.2.rate>=5 for 500 ms", "Front Scan v1.2", ">= 5", 0.5),
        ("/front/scan.status < warn for 2min", "/front/scan", "< warn", 120.0),
        ("doctor.errors == 0", "doctor", "== 0", 0.0),
        ("/battery.percentage > 0.2", "/battery.percentage", "> 0.2", 0.0),
        ("/a.b[:]{id>=3}.score<=1 for 2s", "/a.b[:]{id>=3}.score", "<= 1", 2.0),
        ("/a.rate.@abs != 0", "/a.rate.@abs", "!= 0", 0.0),
    ],
)
def test_a_rule_is_a_subject_a_value_and_a_limit(
    text: str, subject: str, expectation: str, seconds: float
) -> None:
    rule = parse_rule(f" {text} ")
    assert (rule.text, rule.subject, rule.expectation) == (text, subject, expectation)
    assert rule.seconds == seconds


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("/battery > 1", "`/battery > 1` is not a rule. Write it like"),
        ("/a.b.@sum > 1", "Unknown function `@sum`."),
        ("/a.b > error", "error fits status only; /a.b needs a number."),
        ("Scan > 1", "`Scan > 1` is not a rule. Write it like"),
        ("Scan.rate > 5 for ever", "is not a rule"),
        ("Scan.mood > 5", "unknown value mood. Use status, rate,"),
        ("Scan.rate > error", "error fits status only; rate needs a number."),
        ("doctor.rate > 5", "findings and errors are values of doctor only."),
        ("Scan.errors == 0", "findings and errors are values of doctor only."),
    ],
)
def test_a_bad_rule_is_one_sentence(
    text: str, reason: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["test", "--rule", text]) == 2
    assert reason in capsys.readouterr().err


def test_rules_over_a_bag_are_test_cases(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    junit = tmp_path / "report.xml"
    rules = ["LaserScan.rate > 5 for 1min", "LaserScan.status < error", "doctor.errors == 0"]
    options = [word for rule in rules for word in ("--rule", rule)]
    began_s = time.monotonic()
    assert main(["test", "--bag", str(run), *options, "--junit", str(junit)]) == 0
    assert time.monotonic() - began_s < 15.0, "a bag of 20 s is played as if it were live"
    assert "3 of 3 rules hold." in capsys.readouterr().out
    suite = ElementTree.parse(junit).getroot()
    assert [case.get("name") for case in suite.iter("testcase")] == rules
    assert (suite.get("failures"), [*suite.iter("failure")]) == ("0", [])

    failing = ["/scan.rate > 5 for 1s", "Scan.walls > 0.8"]
    options = [word for rule in failing for word in ("--rule", rule)]
    assert main(["test", "--bag", str(run), *options, "--junit", str(junit)]) == 3
    output = capsys.readouterr().out
    assert "FAILED /scan.rate > 5 for 1s\n       /scan.rate is 0." in output
    assert "Scan.walls never had a value. Check the name" in output
    messages = [each.get("message", "") for each in ElementTree.parse(junit).iter("failure")]
    assert len(messages) == 2
    assert messages[0].endswith("expected > 5.")


def test_names_that_xml_cannot_contain_are_readable_in_junit() -> None:
    results = RuleResults(
        "a\x1b[2J\uffff.mcap", [WatchRule(rule="Scan\x08\ufffe\ud800.walls > 0.8")]
    )
    suite = ElementTree.fromstring(results.to_junit())
    (case,) = suite.iter("testcase")
    assert case.attrib == {"classname": "a [2J .mcap", "name": "Scan   .walls > 0.8"}
    (failure,) = suite.iter("failure")
    assert failure.attrib["message"].startswith("Scan   .walls never had a value.")


def test_a_rule_is_about_each_number_that_a_message_path_names(
    run: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    rules = {
        "/charge.data > 0.2": False,
        "/charge.data > 0.2 for 3s": True,
        "/charge.data.@mean(3) > 0.9": True,
        "/charge.date > 0.2": False,
    }
    options = [word for rule in rules for word in ("--rule", rule)]
    assert main(["test", "--bag", str(run), *options]) == 3
    output = capsys.readouterr().out
    for rule, holds in rules.items():
        assert f"{'ok     ' if holds else 'FAILED '}{rule}" in output
    assert "/charge.data is 0.1 at " in output, "one of 200 messages"
    assert "/charge.date never had a value." in output


@pytest.mark.parametrize(
    ("levels", "value"),
    [((), 0.0), ((Level.OK,), 0.0), ((Level.OK, Level.IDLE), 0.0), ((Level.IDLE, Level.WARN), 1.0)],
)
def test_an_idle_display_is_as_good_as_one_that_is_ok(
    levels: Sequence[Level], value: float
) -> None:
    statuses = {f"{number}": Status(level, "") for number, level in enumerate(levels)}
    display = DisplaySeen("1", "LaserScan", LaserScan(name="Scan"), statuses)
    observation = Observation(
        now_ns=1, fixed_frame="map", buffer=TransformBuffer(), displays=[display]
    )
    assert value_of(parse_rule("Scan.status < warn"), observation) == value


@pytest.mark.skipif(not WIDE.exists(), reason="the shared data is absent")
def test_a_rule_is_about_numbers_beside_a_wide_string(capsys: pytest.CaptureFixture[str]) -> None:
    rules = "/odd.x <= 1", "/odd.x < 0.5", "/odd.w == 1"
    options = [word for rule in rules for word in ("--rule", rule)]
    assert main(["test", "--bag", str(WIDE), *options]) == 3
    output = capsys.readouterr().out
    assert "ok     /odd.x <= 1 (-0." in output
    assert "/odd.x is 0." in output
    assert "/odd.w never had a value. Check the name, that it is a number" in output


def test_a_rule_of_the_config_is_tested(
    run: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    config = tmp_path / "lab.yaml"
    config.write_text("displays: [{type: LaserScan}]\nfixed_frame: odom\n")
    assert main(["test", "--bag", str(run), "-d", str(config)]) == 1
    assert "No rules to check." in capsys.readouterr().err
    assert main(["test", "--bag", str(run)]) == 2
    assert "No rules to check." in capsys.readouterr().err
    rule = "watch: [{rule: LaserScan.delay < 1}]\n"
    config.write_text(rule + config.read_text())
    assert main(["test", "--bag", str(run), "-d", str(config)]) == 0
    assert "ok     LaserScan.delay < 1" in capsys.readouterr().out


def test_a_violated_rule_is_a_finding(webviz_harness: Callable[..., Harness]) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    stage.viewer.settings.watch = (WatchRule(rule="Scan.walls > 0.8 for 2s"),)
    look(stage, HERE)
    assert examining.examined(stage, CauseLevel.DATA) == {}
    look(stage, Pose2D(-1.0, 0.5, 0.0), building.scan(HERE))
    findings = examining.examined(stage, CauseLevel.DATA)
    finding = findings["DATA012 Scan.walls > 0.8 for 2s"]
    assert finding.cause.startswith("Scan.walls is 0.")
    assert finding.cause.endswith(", expected > 0.8.")
    look(stage, HERE)
    assert examining.examined(stage, CauseLevel.DATA) == {}


def test_a_rule_of_a_running_viewer_reads_topics_that_no_display_shows(
    webviz_harness: Callable[..., Harness], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)  # the rule saves what led to it
    stage = webviz_harness(LaserScan(), fixed_frame="map")
    stage.viewer.settings.watch = (WatchRule(rule="/charge.data > 0.2"),)
    results: list[str] = []
    for charged in (1.0, 0.1, 1.0):
        cdr = encode(NUMBER, {"data": charged})
        findings = stage.findings(publish=partial(stage.publish_bytes, "/charge", NUMBER, cdr))
        results.append(" ".join(each.cause for each in findings if each.id == "DATA012"))
    assert results == ["", "/charge.data is 0.1, expected > 0.2.", ""]
