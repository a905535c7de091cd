"""The handles of all displays, and which browser holds each."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import Any, ClassVar

import msgspec

from webviz.api.errors import Error
from webviz.api.frames import is_placeable
from webviz.api.handles import Control, Drag, Facing, Handle, MenuEntry, Mode, Wxyz
from webviz.api.nodes import Pose
from webviz.api.roles import Role
from webviz.engine.commands import Sender
from webviz.engine.feature import command, store
from webviz.engine.forms import brief
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.pipeline import Runner
from webviz.engine.pipeline.dragging import reference_group
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.page.page_request import PageRequest

MAX_DRAGS = 50
"""Drags other than moves, of a browser within a second; people make one or two."""
FORGOTTEN_S = 10.0
"""Time in seconds after which the drag of a silent browser is forgotten."""


class _Hand(msgspec.Struct):
    """Drag of one browser.

    Args:
        answer: the last move, until the frame loop has taken it up.
        next: the newest move since.
        heard_s: when it did something.
    """

    answer: Future[str] | None = None
    next: tuple[PageRequest, Any] | None = None
    heard_s: float = 0.0


class DragMessages:
    """Passes on drags. Of these, only refusals are answered.

    Args:
        dispatcher: of what pages ask for.
        clock: monotonic time in seconds.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._enqueue = dispatcher.enqueue
        dispatcher.take("DragHandle", self.drag, _most)
        self._clock = clock
        self._hands: dict[int, _Hand] = {}

    def drag(self, page_request: PageRequest, command: Any) -> None:
        """Pass a drag on, at once unless a move before it still waits for the frame loop."""
        now = self._clock()
        hands = self._hands.items()
        self._hands = {id: hand for id, hand in hands if now - hand.heard_s < FORGOTTEN_S}
        hand = self._hands.setdefault(page_request.browser, _Hand())
        hand.heard_s = now
        if command.drag.kind == "move":
            hand.next = page_request, command
            if hand.answer is None or hand.answer.done():
                self._move(hand)
            return
        if hand.next is not None:
            self._move(hand)
        self._send(page_request, command)

    def _move(self, hand: _Hand) -> None:
        """Pass on the newest move."""
        move, hand.next = hand.next, None
        if move is not None:
            hand.answer = self._send(*move)

    def _send(self, page_request: PageRequest, command: Any) -> Future[str]:
        result = self._enqueue(command, page_request.sender)
        result.add_done_callback(page_request.refused_by)
        return result


def _most(command: Any) -> int:
    """Return how many such drags a browser may send within a second: of moves, one is done."""
    return 0 if command.drag.kind == "move" else MAX_DRAGS


SILENCE_S = 3.0
"""Time in seconds after which a browser that holds a handle is taken to be gone; it reports every
half second."""


MAX_HELP = 300
MAX_TITLE = 200


class HandleControl(msgspec.Struct, frozen=True):
    """A control of a handle, see `webviz.api.handles.Control`."""

    mode: Mode
    facing: Facing
    wxyz: Wxyz
    always: bool
    help: str
    turned: float


class HandleMenuEntry(msgspec.Struct, frozen=True):
    """An entry of a menu, see `webviz.api.handles.MenuEntry`."""

    id: int
    title: str
    checked: bool | None
    refusal: str
    entries: Sequence[HandleMenuEntry]


class SceneHandle(msgspec.Struct, frozen=True):
    """A handle as pages draw it, see `webviz.api.handles.Handle`.

    Args:
        frame: group of the scene that its pose is relative to, "" for the fixed frame.
        holder: the browser that holds it, None for none.
    """

    name: str
    frame: str
    controls: Sequence[HandleControl]
    menu: Sequence[HandleMenuEntry]
    aids: bool
    refusal: str
    holder: int | None


class HandlesStore(PageStore, frozen=True):
    """The handles, by the id of their display and their key with a slash between."""

    spread: ClassVar = {"handles": ""}

    handles: Mapping[str, SceneHandle]


class _Hold(msgspec.Struct):
    """A handle in the hands of a browser.

    Args:
        browser: that holds it.
        drag: its newest.
        heard_s: when that came, monotonic.
    """

    browser: int | None
    drag: Drag
    heard_s: float


class HandlesFeature(PageFeature):
    """Passes on what browsers do with handles; each is held by one browser at a time."""

    name = "Handles"
    module = "handles.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._holds: dict[tuple[str, str], _Hold] = {}
        self._handles_by_node: Mapping[tuple[str, str], tuple[Handle, int | None]] = {}
        self._found_of: object = None
        """Inputs of these."""
        self._store: tuple[object, HandlesStore] | None = None
        """Source of the store, and the store."""

    def attach(self, dispatcher: Dispatcher) -> None:
        """Take the drags of pages."""
        DragMessages(dispatcher)

    def keep_up(self, commanded: bool) -> None:
        """Release what silent browsers hold, and forget handles that are gone."""
        for (display, key), hold in list(self._holds.items()):
            runner = self._runner(display)
            if runner is None or key not in runner.handles():
                del self._holds[display, key]
            elif self.context.clock() - hold.heard_s > SILENCE_S:
                del self._holds[display, key]
                drag = replace(hold.drag, kind="release", pose=None, point=None)
                runner.drag(drag, self.context.frames)

    def is_attended(self) -> bool:
        """Return whether a browser holds a handle."""
        return bool(self._holds)

    def state(self) -> Mapping[str, Any]:
        """Return all handles, with the browsers that hold them."""
        return {"handles": self.found()}

    @store(name="handles")
    def handles_store(self, argument: str) -> HandlesStore:
        """Return the handles of all displays."""
        entries = self.found()
        if self._store is None or self._store[0] is not entries:
            handles = {f"{at[0]}/{at[1]}": _handle(at[0], *each) for at, each in entries.items()}
            self._store = entries, HandlesStore(handles)
        return self._store[1]

    def found(self) -> Mapping[tuple[str, str], tuple[Handle, int | None]]:
        """Return all handles with their holders, by the id of their display and their key."""
        holders = {place: hold.browser for place, hold in self._holds.items()}
        of = [(runner.id, runner.handles()) for runner in self._runners()], holders
        if self._found_of != of:  # quick, as unchanged handles are the same mapping
            self._found_of = of
            self._handles_by_node = {
                (display, key): (handle, holders.get((display, key)))
                for display, handles in of[0]
                for key, handle in handles.items()
            }
        return self._handles_by_node

    @command(Role.OPERATOR)
    def drag_handle(self, display: str, drag: Drag, sender: Sender) -> None:
        """Do something with a handle; see `webviz.api.handles.Drag`.

        Args:
            display: id of the display that has it.
            drag: what is done.
        """
        drag, place = _checked(drag), (display, drag.handle)
        runner = self._runner(display)
        handle = runner.handles().get(drag.handle) if runner else None
        if runner is None or handle is None or not 0 <= drag.control < len(handle.controls):
            raise Error("This handle no longer exists.")
        if handle.refusal:
            raise Error(handle.refusal)
        hold = self._holds.get(place)
        if hold is not None and hold.browser != sender.browser:
            raise Error(
                f"{handle.name}: in use by browser {hold.browser}. Wait until it is released."
            )
        if drag.kind == "press":
            if hold is not None:  # whose release got lost
                runner.drag(replace(hold.drag, kind="release", pose=None), self.context.frames)
            self._holds[place] = _Hold(sender.browser, drag, self.context.clock())
        elif drag.kind == "release":
            if self._holds.pop(place, None) is None:
                return
        elif drag.kind != "choose":
            if hold is None or hold.drag.control != drag.control:
                return  # it was taken from a browser that was silent for too long
            hold.drag, hold.heard_s = drag, self.context.clock()
        runner.drag(drag, self.context.frames)

    def _runners(self) -> Sequence[Runner]:
        return list(self.context.get(DisplaysPart).list.active())

    def _runner(self, id: str) -> Runner | None:
        return next((each for each in self._runners() if each.id == id), None)


def _checked(drag: Drag) -> Drag:
    """Return a drag with a finite pose and point within reach, and a unit quaternion."""
    pose = drag.pose
    if pose is not None:
        length = math.hypot(*pose.wxyz)
        if not (is_placeable(pose) and length > 1e-6):
            raise Error("Not moved: the pose is not finite, or too far away.")
        w, x, y, z = (value / length for value in pose.wxyz)
        pose = Pose(pose.position, (w, x, y, z))
    if drag.point is not None and not is_placeable(Pose(drag.point)):
        drag = replace(drag, point=None)
    if not math.isfinite(drag.turned):
        raise Error("Not moved: the angle is not finite.")
    return replace(drag, pose=pose, turned=math.remainder(drag.turned, 4 * math.pi))


def _handle(display: str, handle: Handle, holder: int | None) -> SceneHandle:
    return SceneHandle(
        name=brief(handle.name, MAX_TITLE),
        frame=reference_group(display, handle.frame) if handle.frame else "",
        controls=[_control(control) for control in handle.controls],
        menu=_menu(handle.menu),
        aids=handle.aids,
        refusal=handle.refusal,
        holder=holder,
    )


def _control(control: Control) -> HandleControl:
    return HandleControl(
        mode=control.mode,
        facing=control.facing,
        wxyz=control.wxyz,
        always=control.is_always_visible,
        help=brief(control.help, MAX_HELP),
        turned=control.turned,
    )


def _menu(entries: Iterable[MenuEntry]) -> list[HandleMenuEntry]:
    return [
        HandleMenuEntry(
            id=entry.id,
            title=brief(entry.title, MAX_TITLE),
            checked=entry.is_checked,
            refusal=entry.refusal,
            entries=_menu(entry.entries),
        )
        for entry in entries
    ]
