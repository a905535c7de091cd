"""Rights for this session: an owner allows what the viewer refuses, by name; others ask for it."""

from __future__ import annotations

import ipaddress
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from typing import Any, ClassVar

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.names import problem_of
from webviz.engine.commands import Command
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.feature import command, commands, store
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.pipeline.own_names import PATTERN, own_names
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.page.page_request import PageRequest

MAX_ALLOWED = 100
MAX_REQUESTS = 8
REQUEST_S = 600.0
"""Time after which an unanswered request is dropped."""
PAUSE_S = 5.0
"""Pause in seconds between two requests of one link."""
DECLINED_S = 60.0
"""Time for which a link cannot ask again for what was declined."""
ACTION = "/_action/"
PARAMETERS = "/set_parameters"
NOT_ONE_NAME = (
    "Not allowed: expected the full name of one topic, service or action, such as /calibrate."
)
ELSEWHERE = (
    "Not allowed: pages of other machines give no rights. Open the page on the machine of the "
    "viewer, or restart it with `--allow-publish {}`."
)
PAGES_ONLY = "Only an owner does this, in the page. Programs give `allow_publish` at the start."


class _Request(msgspec.Struct, frozen=True):
    """A request of a person who is not an owner.

    Args:
        name: what is to be allowed.
        browser, link: whose request it is.
        at_s: when it was made, in monotonic seconds.
        is_declined: whether an owner has said no.
    """

    name: str
    browser: int
    link: str
    at_s: float
    is_declined: bool = False


class PermissionStore(PageStore, frozen=True):
    """The right to use one name.

    Args:
        refusal: why nothing may be sent there, a sentence; "" if it may.
        is_open: whether an owner can allow it.
        is_allowed: whether one has, for this session.
        file: the config file that can allow it for good, "" for none.
        requests: ids of the browsers that have asked for it.
        declined: of those, the ones whose request was declined.
    """

    refusal: str
    is_open: bool
    is_allowed: bool
    file: str
    requests: Sequence[int]
    declined: Sequence[int]


class PermissionRequest(msgspec.Struct, frozen=True):
    """A request that waits for an owner.

    Args:
        who: asks for it.
        use: of the name, such as "call /calibrate".
    """

    who: str
    use: str


class PermissionRequestsStore(PageStore, frozen=True):
    """The requests that wait, by name; and what is allowed for this session."""

    spread: ClassVar = {"requests": ""}

    requests: Mapping[str, PermissionRequest]
    allowed: Sequence[str]


class RightsFeature(PageFeature):
    """Lets owners allow names until the viewer ends, and others ask them to.

    What pages ask for is done on the event loop, the only thread that changes it; the graph alone
    decides by it.
    """

    name = "Rights"
    module = "rights.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._requests: tuple[_Request, ...] = ()
        self._dispatcher: Dispatcher | None = None

    def attach(self, dispatcher: Dispatcher) -> None:
        """Take what pages ask for."""
        self._dispatcher = dispatcher
        for name, handler in (
            ("Allow", self._allow),
            ("Forbid", self._forbid),
            ("AskOwner", self._ask),
            ("Decline", self._decline),
        ):
            dispatcher.take(name, handler)

    # Commands: their names, fields and roles. No program does them, so no plug-in either.

    @command(Role.OWNER, is_noted=True)
    def allow(self, name: str, always: bool = False) -> None:
        """Allow a topic, service or action until the viewer ends.

        Args:
            name: full, no pattern.
            always: whether the config file is to allow it from the next start on, too.
        """
        raise Error(PAGES_ONLY)

    @command(Role.OWNER, is_noted=True)
    def forbid(self, name: str) -> None:
        """Take back what was allowed for this session."""
        raise Error(PAGES_ONLY)

    @command(Role.OPERATOR, is_noted=True)
    def ask_owner(self, name: str) -> None:
        """Ask the owners to allow a topic, service or action."""
        raise Error(PAGES_ONLY)

    @command(Role.OWNER, is_noted=True)
    def decline(self, name: str) -> None:
        """Answer a request with no."""
        raise Error(PAGES_ONLY)

    @command(None, label=lambda each: f"Allow {each.name}")
    def list_name(self, name: str) -> None:
        """Have the list of the config contain a name, unless a config without one uses it."""
        settings = self.context.get(SettingsPart)
        publish = settings.settings.publish
        if publish is None:
            if name in self._own_names():
                return
            publish = self.context.graph.rights.names
        settings.set("publish", [*dict.fromkeys((*publish, name))])

    @store()
    def permission(self, name: str) -> PermissionStore | None:
        """Return the right to use a name; None for an invalid one."""
        graph = self.context.graph
        try:
            full = self._full(name)
        except Error:
            return None
        waiting = [each for each in self._current() if each.name == full]
        path = self.context.get(ConfigPart).path
        return PermissionStore(
            refusal=graph.lasting_refusal(full),
            is_open=graph.is_open(full),
            is_allowed=full in graph.session,
            file=path.name if path and path.suffix != ".rviz" else "",
            requests=[each.browser for each in waiting],
            declined=[each.browser for each in waiting if each.is_declined],
        )

    @store(Role.OWNER)
    def permission_requests(self, argument: str) -> PermissionRequestsStore:
        """Return the requests that wait for an owner."""
        waiting = [each for each in self._current() if not each.is_declined]
        return PermissionRequestsStore(
            {each.name: PermissionRequest(each.link, self._use(each.name)) for each in waiting},
            sorted(self.context.graph.session),
        )

    # Called on the event loop

    def _allow(self, page_request: PageRequest, command: Any) -> None:
        graph = self.context.graph
        try:
            name = self._full(command.name)
        except Error as error:
            page_request.refuse(str(error))
            return
        if not self._is_on_this_machine(page_request.browser):
            page_request.refuse(ELSEWHERE.format(name))
        elif name not in graph.session and not graph.is_open(name):
            page_request.refuse(graph.lasting_refusal(name) or f"{name} is allowed already.")
        elif len(graph.session) >= MAX_ALLOWED:
            page_request.refuse(
                f"{MAX_ALLOWED} names are allowed for this session, which is the limit."
            )
        else:
            graph.allow(name)
            self._requests = tuple(each for each in self._requests if each.name != name)
            text = f"Allowed for this session: {self._use(name)}."
            if command.always:
                self._keep(page_request, name, text)
            else:
                self._answer(page_request, text)

    def _keep(self, page_request: PageRequest, name: str, text: str) -> None:
        """Have the config file allow a name, too, and answer once it is saved."""
        assert self._dispatcher
        enqueue = self._dispatcher.enqueue
        listed = enqueue(_command("ListName", name=name), page_request.sender)

        def tell(saved: Future[str]) -> None:
            if saved.cancelled() or saved.exception() is not None:
                page_request.answer(f"{text} Not kept: {saved.exception()}", "warn")
            else:
                self._answer(page_request, f"{text} {saved.result()}")

        def save(_: Future[str]) -> None:
            enqueue(_command("Save"), page_request.sender).add_done_callback(tell)

        listed.add_done_callback(save)

    def _forbid(self, page_request: PageRequest, command: Any) -> None:
        if command.name not in self.context.graph.session:
            page_request.refuse("Failed: this is not allowed for this session.")
            return
        self.context.graph.forbid(command.name)
        self._answer(page_request, f"No longer allowed: {self._use(command.name)}.")

    def _ask(self, page_request: PageRequest, command: Any) -> None:
        try:
            name = self._full(command.name)
        except Error as error:
            page_request.refuse(str(error))
            return
        assert self._dispatcher
        grant = self._dispatcher.channel.grant_of(page_request.browser)
        if problem := self._excess(name, grant.name if grant else ""):
            page_request.refuse(problem)
            return
        link = grant.name if grant else ""
        request = _Request(name, page_request.browser, link, time.monotonic())
        self._requests = (*self._current(), request)
        owners = [v for v in self._dispatcher.channel.visitors().values() if v.role is Role.OWNER]
        remark = "" if owners else " No owner is connected; the next one to connect will see it."
        self._answer(page_request, f"Asked the owner: {self._use(name)}.{remark}")

    def _decline(self, page_request: PageRequest, command: Any) -> None:
        if not any(each.name == command.name for each in self._current()):
            page_request.refuse("Failed: this request no longer exists.")
            return
        self._requests = tuple(
            msgspec.structs.replace(each, is_declined=True, at_s=time.monotonic())
            if each.name == command.name
            else each
            for each in self._requests
        )
        self._answer(page_request, f"Not allowed for now: {self._use(command.name)}.")

    def _answer(self, page_request: PageRequest, text: str) -> None:
        """Answer once the pages show what has changed."""
        assert self._dispatcher
        result = self._dispatcher.enqueue(_command("Refresh"), page_request.sender)
        result.add_done_callback(lambda _: page_request.answer(text))

    def _excess(self, name: str, link: str) -> str:
        """Return why a request of a link is not passed on, "" if it is."""
        if not self.context.graph.is_open(name):
            return self.context.graph.lasting_refusal(name) or f"{name} is allowed already."
        now, current = time.monotonic(), self._current()
        if any(each.name == name and not each.is_declined for each in current):
            return "The owner has been asked for this already."
        if any(each.name == name and each.link == link for each in current):
            return "The owner declined for now. Ask again in a minute."
        if any(each.link == link and now - each.at_s < PAUSE_S for each in current):
            return "The owner was asked a moment ago. Wait a few seconds."
        if len(current) >= MAX_REQUESTS:
            return f"{MAX_REQUESTS} requests wait for the owner, which is the limit."
        return ""

    def _current(self) -> tuple[_Request, ...]:
        """Return the requests that still count."""
        now = time.monotonic()
        return tuple(
            each
            for each in self._requests
            if now - each.at_s < (DECLINED_S if each.is_declined else REQUEST_S)
        )

    def _is_on_this_machine(self, browser: int) -> bool:
        assert self._dispatcher
        visitor = self._dispatcher.channel.visitors().get(browser)
        try:
            return visitor is not None and ipaddress.ip_address(visitor.address).is_loopback
        except ValueError:
            return False

    def _full(self, name: str) -> str:
        """Return the full name of one topic, service or action.

        Raises:
            Error: it is a pattern, or cannot be a name.
        """
        is_full = name.startswith("/") and not name.endswith("/") and ACTION not in name
        if not is_full or problem_of(name) or not PATTERN.isdisjoint(name):
            raise Error(NOT_ONE_NAME)
        try:
            return self.context.player.resolve(name)
        except ValueError as error:
            raise Error(NOT_ONE_NAME) from error

    def _use(self, name: str) -> str:
        """Say what a name is used for, as far as the graph knows it."""
        if name.endswith(PARAMETERS):
            return f"change the parameters of {name.removesuffix(PARAMETERS)}"
        if name in self.context.graph.services():
            return f"call {name}"
        if f"{name}{ACTION}feedback" in self.context.offers:
            return f"send goals to {name}"
        return f"publish on {name}"

    def _own_names(self) -> set[str]:
        """Return what the current config uses, which it may if it has no list."""
        names = set()
        for each in own_names(
            self.context.get(ConfigPart).config(), ErrorBoundary("Rights", strict=False)
        ):
            try:
                names.add(self.context.player.resolve(each))
            except ValueError:
                continue
        return names


def _command(name: str, /, **fields: Any) -> Command:
    """Return a command by its name: the classes are made once all features are loaded."""
    return commands()[name].type(**fields)
