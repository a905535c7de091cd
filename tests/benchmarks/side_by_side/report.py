"""Writes figures into the READMEs.

    python -m side_by_side.report FILE.json ...   # of `make bench ARGS="--json FILE.json"`

The table in `tests/benchmarks/README.md` is made from the files, of which each has other scenes,
the one in `README.md` from that table, which a test holds.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median
from typing import Any

from side_by_side.systems.registry import SYSTEMS
from webviz.data.words import counted

ROOT = Path(__file__).parents[3]
BENCHMARKS, README = ROOT / "tests/benchmarks/README.md", ROOT / "README.md"
BEGIN, END = "<!-- begin figures -->", "<!-- end figures -->"
CHOSEN = {
    "D": "a scan of 1080 beams at 40 Hz",
    "TF": "200 frames at 50 Hz",
    "E100k": "100 000 points at 10 Hz",
    "F": "updates of a map of 4000 x 4000 at 5 Hz",
}
"""Scenes in `README.md`, in its words."""
TITLES = {name: system.title for name, system in SYSTEMS.items()}
ALL = 0.98
"""Share of publications that counts as all: some are on their way at the end."""
COMPARISON = ("webviz", "plain viser", "foxglove-sdk")
CELL = re.compile(
    r"(?P<cpu>\S+ %)(, (?P<ms>\S+) / \S+ ms)?(, (?P<shown>\S+) of (?P<all>\S+) shown)?"
)


def table(reports: Sequence[Mapping[str, Any]], titles: Mapping[str, str]) -> str:
    """The table of reports of `side_by_side`: a row for each scene, a column for each system.

    Args:
        reports: as written with `--json`.
        titles: of the systems by name.
    """
    rows = {(_place(row), row["system"]): row for each in reports for row in each["rows"]}
    scenes = dict.fromkeys(scene for scene, _ in rows)
    systems = [name for name in titles if any(name == system for _, system in rows)]
    lines = [_line("scene", *(titles[name] for name in systems)), "| --- |" * (len(systems) + 1)]
    lines[1] = lines[1].replace("||", "|")
    for scene in scenes:
        lines.append(_line(scene, *(_cell(rows.get((scene, name))) for name in systems)))
    return "\n".join(lines)


def _place(row: Mapping[str, Any]) -> str:
    """The scene, and who watched if it was not one client."""
    is_usual = row["load"] == "1"
    return row["scene"] if is_usual else f"{row['scene']}, {row['load']} clients"


def facts(report: Mapping[str, Any]) -> str:
    """Say when and where it was measured, and what else ran there."""
    others = [row["figures"]["others_percent"] for row in report["rows"]]
    usual, most = median(each["median"] for each in others), max(each["most"] for each in others)
    versions = [
        f"{name} {version}" for name, version in report["versions"].items() if name != "webviz"
    ]
    machine = [report[name] for name in ("processor", "memory", "system")]
    where = ", ".join([report["date"], f"webviz {report['commit']}", *machine, *versions])
    rounds, seconds = counted(report["rounds"], "round"), report["seconds of each load"]
    return (
        f"{where}; {rounds} of {seconds:g} s a load. Other programs took {usual:.0f} % of a core "
        f"in the median, {most:.0f} % at most."
    )


def summary(benchmarks: str) -> str:
    """The table of `README.md`, from the text of `tests/benchmarks/README.md`."""
    lines = _between(benchmarks).splitlines()
    head, _, *lines = [_cells(line) for line in lines if line.startswith("|")]
    rows = {line[0]: dict(zip(head, line, strict=True)) for line in lines}
    chosen = [
        _line(title, *(_in_words(rows[scene][system]) for system in COMPARISON))
        for scene, title in CHOSEN.items()
    ]
    titles = ("", "webviz", "plain viser viewer", "foxglove-sdk bridge, draws nothing")
    return "\n".join([_line(*titles), "| --- | --- | --- | --- |", *chosen])


def replaced(text: str, figures: str) -> str:
    """A text with other figures between its marks."""
    before, _, rest = text.partition(BEGIN)
    return f"{before}{BEGIN}\n{figures}\n{END}{rest.partition(END)[2]}"


def _between(text: str) -> str:
    return text.partition(BEGIN)[2].partition(END)[0]


def _cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip("|").split("|")]


def _line(*cells: str) -> str:
    return f"| {' | '.join(cells)} |".replace("|  |", "| |")


def _cell(row: Mapping[str, Any] | None) -> str:
    """Processor time, latencies and memory, and what was shown if it is not all."""
    if row is None:
        return ""
    cpu, memory = (_short(_median(row, name)) for name in ("cpu_percent", "resident_mb"))
    p50, p99 = (_short(_median(row, name)) for name in ("p50_ms", "p99_ms"))
    published, drawn_per_s = _median(row, "published_per_s"), _median(row, "shown_per_s")
    parts = [f"{cpu} %", *([f"{p50} / {p99} ms"] if p50 else ())]
    if published and drawn_per_s is not None and drawn_per_s < ALL * published:
        parts.append(f"{_short(drawn_per_s)} of {_short(published)} shown")
    return ", ".join([*parts, f"{memory} MB"])


def _in_words(cell: str) -> str:
    result = CELL.match(cell)
    assert result, f"no figures of a chosen scene: {cell!r}"
    words = f"{result['cpu']}, {result['ms']} ms"
    if result["shown"] is None:
        return words
    return f"{words}, {100 * (1 - float(result['shown']) / float(result['all'])):.0f} % dropped"


def _median(row: Mapping[str, Any], name: str) -> float | None:
    figure = row["figures"][name]
    return figure and figure["median"]


def _short(value: float | None) -> str:
    return "" if value is None else f"{value:.2g}" if abs(value) < 99.5 else f"{value:.0f}"


def main() -> None:
    """Write both tables."""
    parser = argparse.ArgumentParser(prog="side_by_side.report", description=__doc__)
    parser.add_argument("files", nargs="+", type=Path)
    reports = [json.loads(file.read_text()) for file in parser.parse_args().files]
    setups = dict.fromkeys(map(facts, reports))
    figures = "\n\n".join([*setups, table(reports, TITLES)])
    BENCHMARKS.write_text(replaced(BENCHMARKS.read_text(), figures))
    README.write_text(replaced(README.read_text(), summary(BENCHMARKS.read_text())))


if __name__ == "__main__":
    main()
