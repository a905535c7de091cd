"""Bug reports from strangers: zip files, and what they contain."""

from __future__ import annotations

import io
import json
import tempfile
import warnings
import zipfile
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import msgspec
from bags import strings
from rosbags.rosbag2 import StoragePlugin

from tests.attack.attack import Case, mutated
from tests.attack.media import png_of
from webviz.files.report import BugReport

REPORT = BugReport(source="live", made=1.0, at_ns=2, first_ns=1, last_ns=3)
CONFIGS = (
    b"version: 1\n",
    b"",
    b"a: &a [*a]",
    b"a: &a [x,x]\nb: &b [*a,*a]\nc: &c [*b,*b]\nd: [*c,*c]\n",
    b"x: " + b"[" * 5000,
    b"displays: [{type: LaserScan, topic: /scan}]",
    b"\xff\xfe",
)
NAMES = ("../evil", "/etc/evil", "slice.mcap", "report.json", "con", "a" * 60_000, "\u202ex")
NUMBERS = (
    *("9" * 400, "-" + "9" * 400, "1e999", "-1e308", "NaN", "9223372036854775808", "0.5", "-1"),
    *('"x"', "[]", "{}", "true", "null", '"\\ud800"', '"\\u0000"', "[" * 5000 + "]" * 5000),
)


@cache
def _slice() -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        bag = strings(0, 1, 2).write(Path(folder) / "bag", StoragePlugin.MCAP)
        return next(bag.glob("*.mcap")).read_bytes()


def _facts(random: Random) -> bytes:
    """Return a report.json, of which one value is another."""
    text = msgspec.json.encode(REPORT)
    if random.random() < 0.5:
        facts: dict[str, Any] = json.loads(text)
        field = random.choice(sorted(facts))
        marked = json.dumps({**facts, field: "@"})
        return marked.replace('"@"', random.choice(NUMBERS)).encode()
    return mutated(random, text)


def draw(random: Random) -> Case:
    """Unpacks and plays attacked bug reports in a process of its own."""
    members = {
        "report.json": _facts(random) if random.random() < 0.7 else msgspec.json.encode(REPORT),
        "config.yaml": random.choice((*CONFIGS, *6 * CONFIGS[:1])),
        "slice.mcap": mutated(random, _slice()) if random.random() < 0.5 else _slice(),
    }
    if random.random() < 0.3:
        members["picture.png"] = png_of(
            random.choice((8, 65_535)), 8, 8, 2, random.choice((0, 8 << 20))
        )
    if random.random() < 0.2:
        members.pop(random.choice(sorted(members)))
    file = io.BytesIO()
    with warnings.catch_warnings(), zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        warnings.simplefilter("ignore")  # of names that are there twice
        for name, content in members.items():
            # A date of its own, so that a seed gives the same file again.
            archive.writestr(zipfile.ZipInfo(name), content)
        if random.random() < 0.3:
            archive.writestr(zipfile.ZipInfo(random.choice(NAMES)), b"x")
    data = file.getvalue()
    return Case("a.zip", mutated(random, data) if random.random() < 0.3 else data)
