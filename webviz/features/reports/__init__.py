"""Bug reports of the moment that is shown."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.names import new_path
from webviz.data.transforms import diagnose, tree_text
from webviz.engine.commands import FileCommand, NodePicks, Sender
from webviz.engine.examiner import Examiner
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.views import ViewsPart
from webviz.engine.requests import Job
from webviz.engine.state import Row
from webviz.engine.store import PageStore
from webviz.features.reports.writing import (
    ReportMoment,
    listing,
    namespaces,
    picked,
    read_picture,
    write,
)
from webviz.files.report import PrivateNames, ReportedPick
from webviz.sources.slices import slice_around

ROUNDS, ROUNDS_S = 3, 6.0
"""Number of rounds of the doctor that a report waits for, and how long in seconds."""
REST_S = 0.05


class ReportedThing(msgspec.Struct, frozen=True):
    """A thing that was selected when a bug report was made; see `Pick`.

    Args:
        display: id of its display.
        key: of its node.
        number: in the node, None for meshes and images.
        at: coordinates in the frame of the node, in metres.
    """

    display: str
    key: str
    number: int | None
    at: tuple[float, float, float]


class ReportedStore(PageStore, frozen=True):
    """The selection of the bug report that is shown."""

    things: Sequence[ReportedThing]


class ReportsFeature(Feature):
    """Writes bug reports, and shows what was selected in one that is opened."""

    name = "Report"
    module = "reports.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._reported: tuple[ReportedPick, ...] = ()

    def state(self) -> Mapping[str, Any]:
        """Return the selection of the report that is shown."""
        return {"reported": self._reported}

    @store()
    def reported(self, argument: str) -> ReportedStore | None:
        """Return the selection of the bug report that is shown, None without one."""
        return reported_store(self._reported, self.context.get(DisplaysPart).rows)

    @command(None)
    def restore_selection(self, picks: tuple[ReportedPick, ...]) -> None:
        """Let pages that join select what was selected when a report was made."""
        self._reported = picks

    @command(Role.OWNER, FileCommand)
    def list_report(self, sender: Sender, with_names: bool = False) -> Job[str]:
        """Answer with what a bug report would contain, one member per line.

        Args:
            with_names: whether names of hosts, users and home folders would be in it.
        """
        moment = self._moment(sender, (), with_names)
        if doctor := self.context.find(Examiner):
            doctor.ask()  # so that there are findings once it is written
        return Job(lambda: "\n".join(listing(moment)), lambda text: text)

    @command(Role.OWNER, FileCommand)
    def save_report(
        self,
        sender: Sender,
        picture: str = "",
        selection: tuple[NodePicks, ...] = (),
        with_names: bool = False,
        path: str = "",
    ) -> Job[tuple[Path, str]]:
        """Write a bug report of the moment that is shown.

        Args:
            picture: PNG or JPEG in base64, "" for none.
            selection: of the page that sends this.
            with_names: keep names of hosts, users and home folders.
            path: of the file, only for programs; "" is one in the working folder, named by the
                time.
        """
        if path and sender.browser is not None:
            raise Error("Pages cannot choose the file of a report.")
        image = read_picture(picture)
        moment = self._moment(sender, selection, with_names)
        doctor = self.context.find(Examiner)

        def work() -> tuple[Path, str]:
            until_s = time.monotonic() + ROUNDS_S
            if doctor:
                doctor.ask()
            while doctor and doctor.rounds < ROUNDS and time.monotonic() < until_s:
                time.sleep(REST_S)
                doctor.ask()
            file = Path(path) if path else new_path("webviz_report", ".zip")
            size = write(file, moment, doctor, image)
            return file, f"Saved {file.name}, {max(1, round(size / 1e3)) / 1e3:.3g} MB."

        def then(written: tuple[Path, str]) -> str:
            self.context.outputs.add(written[0], "report", written[1], sender)
            return written[1]

        return Job(work, then)

    def _moment(self, sender: Sender, picks: Sequence[NodePicks], with_names: bool) -> ReportMoment:
        context, rows = self.context, self.context.get(DisplaysPart).rows
        frames = context.buffer.frames()
        config = context.get(ViewsPart).as_seen(context.get(ConfigPart).config(), sender)
        part, source = slice_around(context.player)
        tree = tree_text(context.buffer, context.now_ns)
        problems = diagnose(context.buffer, context.now_ns).problems
        public = {*context.offers, *frames, *namespaces(context.offers)}
        return ReportMoment(
            part,
            source,
            rows,
            context.statuses,
            context.offers,
            context.fact("logged", ()),
            context.fact("warned", ()),
            config,
            "\n".join([tree or "No transforms.", *problems, ""]),
            len(frames),
            picked(picks, rows),
            PrivateNames(public),
            with_names,
        )


def reported_store(picks: Sequence[ReportedPick], rows: Sequence[Row]) -> ReportedStore | None:
    """Return what was selected, with the ids of displays instead of their numbers."""
    things = [
        ReportedThing(rows[each.display].id, each.key, each.number, each.at)
        for each in picks
        if 0 <= each.display < len(rows)
    ]
    return ReportedStore(things) if things else None
