"""Bug reports that somebody was sent: numbers, names and sizes that no report has."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path
from random import Random
from typing import Any

import msgspec
from mcap_files import mcap, plain

from tests.attack.attack import Case, mutated
from tests.attack.files import YAML, Files
from webviz.files.report import BugReport

NUMBERS = ("9" * 400, "-" + "9" * 400, "1e999", "-1e308", "NaN", "9223372036854775808", "0.5")
WORDS = ('"x"', "[]", "{}", "true", '"\\ud800"', '"\\u0000"', "[" * 5000 + "]" * 5000)
NAMES = ("report.json", "config.yaml", "slice.mcap", "picture.png", "../config.yaml", "/etc/x", "")


class Reports(Files):
    """Unpacks such reports, and shows what they say of their moment.

    Args:
        folder: for the files.
    """

    kind = "reports"

    def __init__(self, folder: Path) -> None:
        super().__init__(folder, {})

    def draw(self, random: Random) -> Case:
        report = BugReport(source="live", made=1.0, at_ns=2, first_ns=1, last_ns=3)
        main = json.dumps(msgspec.to_builtins(report))
        for _ in range(random.randint(1, 3)):
            key, old = random.choice([*json.loads(_plain(main)).items()])
            new = random.choice((*NUMBERS, *NUMBERS, *WORDS))
            main = main.replace(f'"{key}": {json.dumps(old)}', f'"{key}": {new}')
        members: dict[str, Any] = {
            "report.json": main.encode(),
            "config.yaml": YAML.encode(),
            "slice.mcap": mcap([plain(1, 2, 3)]),
        }
        if random.random() < 0.3:
            members[random.choice(NAMES)] = random.randbytes(random.choice((0, 9, 5000)))
        file = io.BytesIO()
        with zipfile.ZipFile(file, "w", random.choice((0, 8))) as archive:
            for name, data in members.items():
                # Without the time of day, so that a seed gives the same attack again.
                archive.writestr(zipfile.ZipInfo(name), data)
        data = file.getvalue()
        return Case("bug.zip", mutated(random, data) if random.random() < 0.3 else data)


def _plain(text: str) -> str:
    """Return a text whose odd numbers are readable, to choose one of its keys."""
    for number in (*NUMBERS, *WORDS):
        text = text.replace(f": {number},", ": 0,").replace(f": {number}}}", ": 0}")
    return text
