"""Calls of agents: lines of the Model Context Protocol on standard input."""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from pathlib import Path
from random import Random
from typing import Any

from bags import strings

from tests.attack import commands
from tests.attack.attack import Attack, Case, Outcome, Violation, changed_part, mutated
from tests.attack.target import ANSWER_S, INTERNAL, homes
from webviz.server.access import rules

START_S = 180.0
"""Time in seconds for the start of a viewer on a busy machine."""
HELLO = {
    "protocolVersion": "2025-06-18",
    "capabilities": {},
    "clientInfo": {"name": "attacker", "version": "1"},
}
TOOLS = ("explain", "topics", "read", "transform", "act", "no such tool", "")
NAMES = ("map", "/words", "", "\x00", "\u202e", "<b>", "x" * 50_000, "../../etc/passwd")
ENDINGS = {"Dismiss", "Shutdown", "Quit"}
"""Commands that others would miss."""


class Agents(Attack):
    """Sends lines to `webviz mcp`, and looks whether it still answers.

    Args:
        folder: for a bag and the log.
    """

    kind = "agents"

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._process: subprocess.Popen[str] | None = None
        self._answers: dict[object, dict[str, Any]] = {}
        self._came = threading.Condition()
        self._number = 0

    def start(self) -> None:
        bag = strings(0, 1, 2).write(self._folder / "bag")
        command = [sys.executable, "-m", "webviz", "mcp", "--bag", str(bag), "--port", "0"]
        self._log = (self._folder / "log.txt").open("w+")
        self._process = subprocess.Popen(
            [*command, "--role", "operator"],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            env={"PATH": "/usr/bin:/bin", **homes(self._folder)},
            text=True,
            errors="surrogateescape",
        )
        self._reading = threading.Thread(target=self._read, args=(self._process,), daemon=True)
        self._reading.start()

    def draw(self, random: Random) -> Case:
        tool = random.choice(TOOLS)
        if tool == "act":
            command = random.choice(sorted(each.__name__ for each in rules.commands()))
            fields = commands.arguments(random, command) if command not in ENDINGS else {}
            arguments: dict[str, Any] = {"command": command, "fields": fields}
        else:
            fields = random.sample(("display", "topic", "target", "source"), random.randrange(5))
            arguments = {name: random.choice(NAMES) for name in fields}
        call = {"name": tool, "arguments": arguments}
        line: dict[str, Any] = {"jsonrpc": "2.0", "method": "tools/call", "params": call}
        if random.random() < 0.8:
            line["id"] = random.choice((7, "seven", -1, 2**60, 0.5, None, [], {}))
        if random.random() < 0.5:
            line = changed_part(random, line)
        data = json.dumps(line, ensure_ascii=random.random() < 0.5).encode(errors="replace")
        return Case("a.line", mutated(random, data) if random.random() < 0.3 else data)

    def strike(self, case: Case) -> Outcome:
        if self._number == 0:
            self._write({"method": "initialize", "id": "hello", "params": HELLO})
            self._wait_for("hello", START_S)
            self._write({"method": "notifications/initialized"})
        self._number += 1
        self._send(case.data.replace(b"\n", b" ").decode(errors="surrogateescape"))
        name = f"ping {self._number}"
        self._write({"method": "ping", "id": name})
        self._wait_for(name, ANSWER_S)
        self._log.flush()
        if result := INTERNAL.search((self._folder / "log.txt").read_text(errors="replace")):
            raise Violation(
                f"an internal error in the log: {result.string[result.start() :][:2000]}"
            )
        return Outcome.SURVIVED

    def close(self) -> None:
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
            self._reading.join()
            self._log.close()
        self._process = None

    def _write(self, message: dict[str, Any]) -> None:
        self._send(json.dumps({"jsonrpc": "2.0", **message}))

    def _send(self, line: str) -> None:
        assert self._process is not None
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(f"{line}\n")
            self._process.stdin.flush()
        except BrokenPipeError as error:
            raise Violation("the server of agents has ended") from error

    def _read(self, process: subprocess.Popen[str]) -> None:
        assert process.stdout is not None
        for line in process.stdout:
            try:
                answer = json.loads(line)
            except ValueError:
                answer = {"id": "broken", "line": line}
            with self._came:
                if isinstance(answer, dict) and isinstance(answer.get("id"), str):
                    self._answers[answer["id"]] = answer
                self._came.notify_all()

    def _wait_for(self, name: str, seconds: float) -> None:
        with self._came:
            is_there = self._came.wait_for(
                lambda: name in self._answers or "broken" in self._answers, seconds
            )
            if "broken" in self._answers:
                raise Violation(f"no JSON on standard output: {self._answers.pop('broken')}")
            if not is_there:
                log = (self._folder / "log.txt").read_text(errors="replace")[-1000:]
                raise Violation(f"agents get no answer within {seconds:g} s: {log}")
            self._answers.clear()
