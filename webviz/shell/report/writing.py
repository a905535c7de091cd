"""Tests of bug reports: they fail as the report did, and pass once the fault is repaired."""

from __future__ import annotations

import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Literal

from webviz.api.errors import Error
from webviz.data.words import counted
from webviz.data.working_folder import working_folder
from webviz.files.config.atomic import write_text
from webviz.files.report import BugReport, UnpackedReport, read_report
from webviz.shell.pictures import files as picture_files

Check = Literal["finding", "status", "picture"]
SEVERE = ("warn", "error", "warning")
SIZE = (640, 480)
"""Size of the picture, in pixels."""
MAX_TESTS = 20
HEAD = '''\
"""Fails as long as the fault of a bug report exists; written by `webviz test`.

Once it is repaired, record the robot again and replace {stem}.mcap, or name the new recording in
the environment variable WEBVIZ_BAG.
"""

import os
from pathlib import Path

from webviz.testing import {name}

HERE = Path(__file__).parent
BAG = Path(os.environ.get("WEBVIZ_BAG", HERE / "{stem}.mcap"))
CONFIG = HERE / "{stem}.yaml"
AT_S = {at_s!r}
"""The moment of the report, in seconds from the start."""
'''


def write_test(report: Path, path: Path, check: Check | None) -> str:
    """Write a test, with the recording and the config of its report beside it.

    Args:
        report: the zip file.
        path: of the test; files of the same name with other endings must not exist either.
        check: which part of the report is tested; None for findings, or else statuses, or else
            the picture.

    Returns:
        A sentence on what was written.

    Raises:
        Error: the report cannot be read, has no such part, or a file exists already.
    """
    files = [path, *(path.with_suffix(suffix) for suffix in (".mcap", ".yaml", ".png"))]
    for each in files:
        if each.exists():
            raise Error(f"{each} exists already. Choose another name with -o.")
    with working_folder("webviz_report_") as folder:
        unpacked = read_report(report, folder)
        chosen = check or _most_telling(unpacked.report)
        tests = list(_tests(unpacked.report, chosen, path.stem))[:MAX_TESTS]
        if not tests:
            raise Error(f"{report} has no {chosen} to test. Choose another part with --check.")
        _make_folder(path)
        if chosen == "picture":
            _draw(unpacked, path.with_suffix(".png"))
        _copy(unpacked.bag, path.with_suffix(".mcap"))
        write_text(unpacked.config.read_text(encoding="utf-8"), path.with_suffix(".yaml"))
    name = "looks_like" if chosen == "picture" else "replay"
    head = HEAD.format(stem=path.stem, name=name, at_s=round(unpacked.report.at_s, 6))
    write_text("\n\n".join([head, *tests]), path)
    return f"wrote {path}, {counted(len(tests), 'test')} of {_plural(chosen, len(tests))}."


def _most_telling(report: BugReport) -> Check:
    if any(each.severity in SEVERE for each in report.findings):
        return "finding"
    return "status" if any(_is_telling(report)) else "picture"


def _is_telling(report: BugReport) -> Iterator[bool]:
    return (each.level in SEVERE and each.display != "" for each in report.statuses)


def _tests(report: BugReport, check: Check, stem: str) -> Iterator[str]:
    """Functions as text. Strings of the report, which may be anything, are quoted."""
    if check == "picture":
        yield (
            f"def test_picture() -> None:\n"
            f'    wrong = HERE / "{stem}.png"  # as the report shows it\n'
            f"    assert not looks_like(BAG, CONFIG, AT_S, wrong)\n"
        )
    elif check == "finding":
        ids = [each.id for each in report.findings if each.severity in SEVERE]
        for id in dict.fromkeys(ids):
            yield (
                f"def test_{_identifier(id)}() -> None:\n"
                f"    findings = replay(BAG, CONFIG, AT_S).findings\n"
                f"    assert {id!a} not in findings, findings[{id!a}]\n"
            )
    else:
        wrong = [
            s for s, telling in zip(report.statuses, _is_telling(report), strict=True) if telling
        ]
        for number, each in enumerate(wrong, 1):
            yield (
                f"def test_{number}_{_identifier(f'{each.display}_{each.status}')}() -> None:\n"
                f"    assert replay(BAG, CONFIG, AT_S).problem({each.display!a}, {each.status!a})"
                ' == ""\n'
            )


def _identifier(text: str) -> str:
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")[:60] or "it"


def _plural(check: Check, count: int) -> str:
    several = {"finding": "findings", "status": "statuses", "picture": "pictures"}
    return several[check] if count > 1 else f"a {check}"


def _draw(unpacked: UnpackedReport, path: Path) -> None:
    """Write the picture that the report shows."""
    import PIL.Image

    from webviz.shell.pictures.capture import capture

    captured = capture(
        unpacked.config, bag=unpacked.bag, at=max(0.0, unpacked.report.at_s), size=SIZE
    )
    picture_files.save(PIL.Image.fromarray(captured.pixels), path)


def _make_folder(path: Path) -> None:
    """Make the folder of a file."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise Error(f"Cannot write {path}: {error.strerror}.") from error


def _copy(source: Path, target: Path) -> None:
    with picture_files.writing(target) as file, source.open("rb") as content:
        shutil.copyfileobj(content, file)
