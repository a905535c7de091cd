"""Pages of the doctor's checks, generated from their docstrings: `make docs`."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.check import Check, CheckText
from webviz.api.check_registry import known_checks
from webviz.api.finding import CauseLevel
from webviz.files.rviz.docs import table
from webviz.shell.doctor.report import schema_text
from webviz.shell.reference import COMMAND

FOLDER = "doctor"
SCHEMA = "report.schema.json"


def pages() -> dict[str, str]:
    """Return the text of each file in the folder of the doctor, by name."""
    texts = [CheckText(check) for check in built_in()]
    return {"checks.md": _index(texts), SCHEMA: schema_text()} | {
        f"{text.id}.md": _page(text) for text in texts
    }


def built_in() -> Sequence[type[Check]]:
    """Return the checks that come with webviz."""
    return [check for check in known_checks() if check.__module__.startswith("webviz.")]


def _index(texts: Sequence[CheckText]) -> str:
    lines = ["# The checks of the doctor", ""]
    lines += ["In the order of causes: the level that affects most comes first.", ""]
    for level in CauseLevel:
        if rows := [(f"[{t.id}]({t.id}.md)", t.title) for t in texts if t.level is level]:
            lines += [f"## {level.title.capitalize()}", "", *table(("id", "finds"), rows), ""]
    return "\n".join([*lines, f"Written by `{COMMAND}`.", ""])


def _page(text: CheckText) -> str:
    lines = [f"# {text.id}: {text.title}", ""]
    lines += [f"Level: {text.level.title}. [All checks](checks.md)", ""]
    for title, parts in (("Finds", text.what), ("Why", text.why), ("Repair", text.repair)):
        lines += [f"## {title}", "", *(line for part in parts for line in (part, ""))]
    return "\n".join([*lines, f"Written by `{COMMAND}`.", ""])
