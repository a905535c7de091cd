"""What people ask of a viewer: from any thread, in order, each with an answer."""

from __future__ import annotations

import functools
import logging
import queue
from collections.abc import Callable
from concurrent.futures import Future

import msgspec

from webviz import config as config_file
from webviz.commands import Command
from webviz.config import ConfigError
from webviz.errors import Error
from webviz.pipeline.guard import Guard
from webviz.state import Answer
from webviz.status import Level

log = logging.getLogger("webviz")

MAX_REQUESTS = 1000
ENDED = "The viewer has ended."


class Refused(Error):
    """A command that cannot be done; one sentence says why."""


class Requests:
    """Commands that wait for the frame loop.

    Args:
        guard: notes what commands raise that is not about what was asked for.
    """

    def __init__(self, guard: Guard) -> None:
        self._guard = guard
        self.answer = Answer()
        """To the last command that has one, for panels."""
        self._waiting: queue.Queue[tuple[Command, Future[str]]] = queue.Queue(MAX_REQUESTS)
        self._has_ended = False

    def put(self, command: Command) -> Future[str]:
        """Ask for something; see `FrameLoop.enqueue`."""
        answer: Future[str] = Future()
        try:
            self._waiting.put_nowait((command, answer))
        except queue.Full:
            log.warning("Too many requests at once, ignored: %s", command)
            answer.set_exception(Refused("Too many requests at once."))
        if self._has_ended:
            self.end()
        return answer

    def obey(self, do: Callable[[Command], str]) -> list[Callable[[], None]]:
        """Do what was asked for.

        Args:
            do: carries out a command and returns what there is to tell of it, "" for nothing.

        Returns:
            What tells each of those who asked, to be called once all of it can be seen.
        """
        answers: list[Callable[[], None]] = []
        while (request := self._next()) is not None:
            command, answer = request
            try:
                text = self._in_one_sentence(do, command)
            except Refused as error:
                log.warning("%s", error)
                self.answer = Answer(self.answer.number + 1, Level.ERROR, str(error))
                answers.append(functools.partial(answer.set_exception, error))
            else:
                if text:
                    self.answer = Answer(self.answer.number + 1, Level.OK, text)
                answers.append(functools.partial(answer.set_result, text))
        return answers

    def end(self) -> None:
        """Refuse what still waits, and what comes from now on."""
        self._has_ended = True
        while (request := self._next()) is not None:
            request[1].set_exception(Refused(ENDED))

    def _next(self) -> tuple[Command, Future[str]] | None:
        """The next request of somebody who still wants it."""
        while True:
            try:
                request = self._waiting.get_nowait()
            except queue.Empty:
                return None
            if request[1].set_running_or_notify_cancel():
                return request

    def _in_one_sentence(self, do: Callable[[Command], str], command: Command) -> str:
        try:
            return do(command)
        except ConfigError as error:
            raise Refused(str(error)) from error
        except msgspec.ValidationError as error:
            raise Refused(f"Not changed: {config_file.describe(error)}.") from error
        except AttributeError as error:
            raise Refused(f"Not changed: {error}.") from error
        except (Exception, SystemExit) as error:
            raise Refused(self._guard.note("Command", error)) from error
