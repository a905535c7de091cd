"""Names and texts of others on the terminal: they forge no line and command nothing."""

from __future__ import annotations

import ast
import json
import logging
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import pytest
from bags import TF, Bag, Topic

from webviz.data.names import readable
from webviz.shell.cli.commands import run as cli
from webviz.shell.cli.terminal import LogFormatter, say, say_json, warn

ROOT = Path(__file__).parents[2]
FORGED = "webviz: All is well (121 checks)."
HOSTILE = f"a\x1b[2J\x1b]0;title\x07\u202eb\x9b31m\n{FORGED}\n\r\n{FORGED}\u2028{FORGED}\u2066c"
COMMANDING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
NOT_TEXT = ("webviz/shell/docs.py", "webviz/shell/typings.py")
"""Programs of those who develop webviz."""


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Frames and a topic with hostile names: two trees, one of them with a loop."""
    recorded = Bag({"/tf": Topic(TF), "/scan": Topic("sensor_msgs/msg/LaserScan")})
    for step in range(30):
        at_s = step / 10
        recorded.transform(at_s, "map", HOSTILE)
        recorded.transform(at_s, HOSTILE + "1", HOSTILE + "2")
        recorded.transform(at_s, HOSTILE + "3", HOSTILE + "4")
        recorded.transform(at_s, HOSTILE + "4", HOSTILE + "3")
        scan = {"header": {"frame_id": f"{HOSTILE}9"}, "ranges": [1.0], "range_max": 9.0}
        recorded.put(at_s, "/scan", scan)
    return recorded.write(tmp_path_factory.mktemp("bags") / "hostile")


def check(text: str) -> None:
    """A text commands nothing, and none of its lines is the forged one."""
    assert not COMMANDING.search(text), ascii(COMMANDING.search(text))
    assert FORGED not in text.splitlines()


@pytest.mark.parametrize(
    ("arguments", "place"),
    [
        (["frames", "--bag", "BAG"], "title"),
        (["doctor", "--bag", "BAG"], "title"),
        (["doctor", "--bag", "BAG", "--json"], ""),
        (["test", "--bag", "BAG", "--rule", "doctor.errors == 99"], "doctor"),
        (["report", "--bag", "BAG", "--list"], ""),
        (["screenshot", "--bag", "BAG", "-d", f"no{HOSTILE}.rviz", "-o", "a.png"], "title"),
        (["schema", f"--{HOSTILE}"], "title"),
    ],
    ids=["frames", "doctor", "json", "test", "report", "file", "option"],
)
def test_a_command_writes_lines_that_command_nothing(
    bag: Path, arguments: list[str], place: str, capfd: pytest.CaptureFixture[str]
) -> None:
    cli([str(bag) if word == "BAG" else word for word in arguments])
    output = capfd.readouterr()
    check(output.out)
    check(output.err)
    assert place in output.out + output.err
    if "--json" in arguments:
        assert json.loads(output.out)["findings"]


def test_a_picture_of_frames_has_names_of_one_line(bag: Path, tmp_path: Path) -> None:
    path = tmp_path / "frames.svg"
    cli(["frames", "--bag", str(bag), "-o", str(path)])
    text = path.read_text(encoding="utf-8")
    check(text)
    lines = [line for each in ElementTree.fromstring(text).itertext() for line in each.split("\n")]
    assert FORGED not in lines
    assert any("title" in line for line in lines)


def test_each_line_is_one_and_a_log_too(capsys: pytest.CaptureFixture[str]) -> None:
    say(HOSTILE, "b")
    warn(HOSTILE)
    captured = capsys.readouterr()
    assert captured.out == f"{readable(HOSTILE)}\nb\n"
    assert captured.err == f"{readable(HOSTILE)}\n"
    say_json(json.dumps({"a": HOSTILE}, ensure_ascii=False, indent=2))
    output = capsys.readouterr().out
    check(output)
    assert json.loads(output) == {"a": HOSTILE}
    record = logging.LogRecord("webviz", logging.WARNING, "", 0, "of %s", (HOSTILE,), None)
    assert LogFormatter().format(record) == f"webviz: of {readable(HOSTILE)}"
    try:
        raise ValueError(HOSTILE.replace("\n", " "))
    except ValueError:
        record.exc_info = sys.exc_info()
    check(LogFormatter().format(record))


def test_a_program_logs_in_this_format() -> None:
    program = (
        "import logging; from webviz.shell.cli.commands import run; run(['schema', '--none'])\n"
        f"logging.getLogger('webviz').warning('%s', {HOSTILE!r})"
    )
    completed = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    check(completed.stderr)
    assert completed.stderr.splitlines()[-1] == f"webviz: {readable(HOSTILE)}"


def test_only_one_module_writes_to_the_terminal() -> None:
    """Also `sys.stdout.write`; descriptors are written in `ending` alone, by way of `readable`."""
    doors = {"webviz/shell/cli/terminal.py", *NOT_TEXT}
    # JSON between two machines, and between an agent and the viewer.
    others = {"webviz/shell/doctor/peer_program.py", "webviz/shell/agents/server.py"}
    results = {
        str(path.relative_to(ROOT))
        for path in (ROOT / "webviz").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and _writes(node.func)
    }
    assert results - others <= doors, results - others - doors


def _writes(function: ast.expr) -> bool:
    if isinstance(function, ast.Name):
        return function.id == "print"
    return (
        isinstance(function, ast.Attribute)
        and function.attr in ("write", "writelines")
        and ast.unparse(function.value) in ("sys.stdout", "sys.stderr", "sys.stdout.buffer")
    )


INITIALIZE = {
    "jsonrpc": "2.0",
    "id": 1,
    "method": "initialize",
    "params": {
        "protocolVersion": "2025-03-26",
        "capabilities": {},
        "clientInfo": {"name": "test", "version": "1"},
    },
}


@pytest.mark.parametrize(
    ("arguments", "is_json"),
    [
        (["doctor", "--json", "--seconds", "2"], True),
        (["frames", "--seconds", "0.5"], False),
        (["test", "--rule", "doctor.errors == 99", "--seconds", "1"], False),
        (["mcp", "--port", "0", "--no-restore"], True),
    ],
)
def test_output_of_dds_is_kept_apart_from_results(
    webviz_domain: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    is_json: bool,
) -> None:
    profile = tmp_path / "profile.xml"
    profile.write_text("<dds><profiles><unknown/></profiles></dds>")
    monkeypatch.setenv("FASTRTPS_DEFAULT_PROFILES_FILE", str(profile))
    monkeypatch.setenv("FASTDDS_DEFAULT_PROFILES_FILE", str(profile))
    completed = subprocess.run(
        [sys.executable, "-m", "webviz", *arguments],
        input=f"{json.dumps(INITIALIZE)}\n",
        capture_output=True,
        text=True,
        timeout=120.0,
        check=False,
    )
    assert "XMLPARSER" in completed.stderr, f"DDS complains nowhere: {completed.stderr}"
    assert completed.stdout
    assert "XMLPARSER" not in completed.stdout
    if is_json:
        answer = json.loads(completed.stdout)
        assert answer.get("findings") or answer["result"]["serverInfo"]
