"""Files that never respond, while a person's right ends."""

from __future__ import annotations

import contextlib
import threading
from datetime import UTC, datetime, timedelta
from pathlib import Path
from random import Random
from typing import Literal

import msgspec

from tests.attack.attack import Attack, Case, Outcome, Violation
from tests.attack.target import ANSWER_S
from tests.attack.visitor import Visitor
from webviz.api.roles import Role
from webviz.data.disk import MAX_THREADS, in_thread
from webviz.scene import open_server
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.tokens import Token, make
from webviz.server.http.viser_server import Server


class Hanging(msgspec.Struct):
    """A case.

    Args:
        files: that do not respond.
        ending: of the right of a connected person.
        role: of them.
    """

    files: int
    ending: Literal["revoked", "lowered", "expired"]
    role: Literal["operator", "owner"]


class Disks(Attack):
    """Takes the threads that wait for a disk, then ends the right of a connected person.

    A file system that hangs needs privileges, so the threads wait for something else, in a server
    of this process.

    Args:
        folder: for the file of tokens.
    """

    kind = "disks"

    def __init__(self, folder: Path) -> None:
        self._path = folder / "tokens.json"
        self._late = timedelta()
        self._server: Server | None = None

    def start(self) -> None:
        token_file.modify(self._path, lambda _: [])
        access = Access(True, self._path, now=lambda: datetime.now(UTC) + self._late)
        self._server = open_server(port=0, access=access)
        self._access = access

    def draw(self, random: Random) -> Case:
        hanging = Hanging(
            random.randint(0, 3 * MAX_THREADS),
            random.choice(("revoked", "lowered", "expired")),
            random.choice(("operator", "owner")),
        )
        return Case("hanging.json", msgspec.json.encode(hanging))

    def strike(self, case: Case) -> Outcome:
        assert self._server is not None
        hanging = msgspec.json.decode(case.data, type=Hanging)
        port = self._server.get_port()
        now = datetime.now(UTC) + self._late
        token = make("somebody", Role[hanging.role.upper()], now, days=1.0)
        token_file.modify(self._path, lambda _: [token])
        self._access.refresh()
        visitor = Visitor(port, Cookie=f"webviz_{port}={token.cookie}")
        mounted = threading.Event()
        try:
            with contextlib.suppress(OSError):  # no thread is left, as intended
                for _ in range(hanging.files):
                    in_thread(mounted.wait)
            self._end(token, hanging.ending)
            visitor.answer(0, ANSWER_S)
        except ConnectionResetError:
            return Outcome.REFUSED
        except TimeoutError as error:
            raise Violation(f"a right that is {hanging.ending} is kept") from error
        finally:
            mounted.set()
            visitor.close()
        raise Violation("an answer to nothing")

    def close(self) -> None:
        if self._server is not None:
            self._server.stop()

    def _end(self, token: Token, ending: str) -> None:
        match ending:
            case "revoked":
                token_file.modify(self._path, lambda _: [])
            case "lowered":
                lowered = msgspec.structs.replace(token, role="watcher")
                token_file.modify(self._path, lambda _: [lowered])
            case _:
                self._late += timedelta(days=1.0)
