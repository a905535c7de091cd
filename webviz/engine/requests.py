"""Requests to a viewer: commands from any thread, in order, each with an answer."""

from __future__ import annotations

import contextlib
import functools
import queue
import threading
from collections.abc import Callable
from concurrent.futures import Future, wait
from typing import Any, Generic, TypeVar

import msgspec

from webviz.api.errors import Error
from webviz.data.disk import in_thread
from webviz.engine.commands import MAX_PRIORITY, Command, FileCommand, Sender
from webviz.engine.error_boundary import ErrorBoundary

MAX_REQUESTS = 1000
"""Largest number of requests that wait for the frame loop; those of a lower priority fill a part of
it."""
MAX_FILES = 20
"""File commands of programs that wait for the disk; of each browser it is one."""
ENDING_S = 1.0
"""Time `end` waits for a file that is being written."""
ENDED = "The viewer has ended."

T = TypeVar("T")


class Refused(Error):
    """A command was refused; one sentence says why."""


class Job(msgspec.Struct, Generic[T], frozen=True):
    """The slow part of a command: the disk, or a long text.

    Args:
        work: runs in a thread of its own; must not touch the state of the frame loop.
        then: called by the frame loop with the result; returns the answer.
    """

    work: Callable[[], T]
    then: Callable[[T], str]


class LoopCalls:
    """Calls that wait for a moment between two turns of the frame loop.

    They need no bound: each thread waits for its own.

    Args:
        wake: called from any thread when one waits.
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._waiting: queue.SimpleQueue[tuple[Callable[[], Any], Future[Any]]]
        self._waiting = queue.SimpleQueue()
        self._thread: int | None = None

    def begin(self) -> None:
        """Note that this thread runs the frame loop from now on."""
        self._thread = threading.get_ident()

    def end(self) -> None:
        """Note that none does any more."""
        self._thread = None
        self.answer()

    def put(self, call: Callable[[], T]) -> Future[T]:
        """Call something as soon as no turn is under way; from any thread."""
        future: Future[T] = Future()
        self._waiting.put((call, future))
        if self._thread in (None, threading.get_ident()):
            self.answer()
        else:
            self._wake()
        return future

    def answer(self) -> None:
        """Do what waits."""
        with contextlib.suppress(queue.Empty):
            while True:
                call, future = self._waiting.get_nowait()
                try:
                    future.set_result(call())
                except Exception as error:
                    future.set_exception(error)


Request = tuple[Command, Sender, Future[str]]


class Requests:
    """Commands that wait for the frame loop.

    File commands run in a thread, one after the other, those of a higher priority first; other
    commands overtake them.

    Args:
        boundary: logs unexpected exceptions of commands.
        wake: called from any thread when slow work is done.
    """

    def __init__(self, boundary: ErrorBoundary, wake: Callable[[], None]) -> None:
        self._boundary = boundary
        self._wake = wake
        self._waiting: queue.SimpleQueue[Request] = queue.SimpleQueue()
        self._files: list[Request] = []
        self._running: tuple[Future[Any], Job[Any], Future[str]] | None = None
        self._has_ended = False

    def put(self, command: Command, sender: Sender) -> Future[str]:
        """Enqueue a command; see `FrameLoop.enqueue`."""
        answer: Future[str] = Future()
        if self._waiting.qsize() < MAX_REQUESTS * sender.priority // MAX_PRIORITY:
            self._waiting.put((command, sender, answer))
        else:
            answer.set_exception(Refused("Too many requests at once. Try again later."))
        if self._has_ended:
            self._refuse_waiting()
        return answer

    def obey(self, do: Callable[[Command, Sender], str | Job[Any]]) -> list[Callable[[], None]]:
        """Carry out the waiting commands.

        Args:
            do: carries out a command and returns its answer, "" for none, or its slow part.

        Returns:
            Callbacks that deliver the answers, to be called once the effects are visible.
        """
        answers = self._finish()
        while (request := self._next()) is not None:
            command, sender, answer = request
            answers += self._attempt(answer, functools.partial(do, command, sender))
        return answers

    def end(self) -> None:
        """Finish a file that is being written, and refuse all other commands from now on.

        Called by the frame loop.
        """
        self._has_ended = True
        if self._running is not None:
            wait([self._running[0]], ENDING_S)
            for answer in self._finish():
                answer()
        if self._running is not None:
            self._running[2].set_exception(Refused(ENDED))
            self._running = None
        while self._files:
            _refuse(self._files.pop(), ENDED)
        self._refuse_waiting()

    def _finish(self) -> list[Callable[[], None]]:
        """Finish a command whose slow part is done."""
        if self._running is None or not self._running[0].done():
            return []
        future, job, answer = self._running
        self._running = None
        return self._attempt(answer, lambda: job.then(future.result()))

    def _attempt(
        self, answer: Future[str], act: Callable[[], str | Job[Any]]
    ) -> list[Callable[[], None]]:
        """Act; returns the callback with the answer, nothing while a slow part runs."""
        try:
            result = self._in_one_sentence(act)
            if isinstance(result, Job):
                self._begin(result, answer)
                return []
        except Refused as error:
            # Without a traceback, which refers to the answer: the garbage of a flood of commands
            # would stop all threads for so long that a driven robot stutters.
            return [functools.partial(answer.set_exception, Refused(str(error)))]
        return [functools.partial(answer.set_result, result)]

    def _begin(self, job: Job[Any], answer: Future[str]) -> None:
        try:
            working = in_thread(job.work)
        except OSError as error:
            raise Refused(f"Failed: {error.strerror}.") from error
        self._running = working, job, answer
        working.add_done_callback(lambda _: self._wake())

    def _next(self) -> Request | None:
        """Return the next request that was not cancelled and may run now."""
        while True:
            if self._files and self._running is None:
                request = max(self._files, key=lambda each: each[1].priority)
                self._files.remove(request)
            else:
                try:
                    request = self._waiting.get_nowait()
                except queue.Empty:
                    return None
                if self._running is not None and isinstance(request[0], FileCommand):
                    self._defer(request)
                    continue
            if request[-1].set_running_or_notify_cancel():
                return request

    def _in_one_sentence(self, act: Callable[[], str | Job[Any]]) -> str | Job[Any]:
        try:
            return act()
        except Error as error:
            raise Refused(str(error)) from error
        except AttributeError as error:
            raise Refused(f"Not changed: {error}.") from error
        except (Exception, SystemExit) as error:
            raise Refused(self._boundary.note("Command", error)) from error

    def _defer(self, request: Request) -> None:
        browser = request[1].browser
        limit = MAX_FILES if browser is None else 1
        if sum(other.browser == browser for _, other, _ in self._files) < limit:
            self._files.append(request)
        else:
            _refuse(request, "Too many files at once. Try again later.")

    def _refuse_waiting(self) -> None:
        """Refuse all waiting requests; from any thread."""
        with contextlib.suppress(queue.Empty):
            while True:
                _refuse(self._waiting.get_nowait(), ENDED)


def _refuse(request: Request, reason: str) -> None:
    if request[-1].set_running_or_notify_cancel():
        request[-1].set_exception(Refused(reason))
