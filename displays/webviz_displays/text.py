"""The Text display."""

from __future__ import annotations

from typing import Annotated, Any

import msgspec

from webviz import Context, Display, Input, Pane, Prop, Sample, Topic
from webviz.api.pictures import Readout
from webviz.api.ports import ANY
from webviz.data.messages.paths import FieldPath, PathError
from webviz.data.words import counted

MAX_FIELDS = 100
SECOND = 1_000_000_000


class _State(msgspec.Struct):
    """Kept between messages."""

    newest: Pane | None = None
    pane: Pane | None = None
    shown_ns: int = 0
    settings: tuple[Any, ...] = ()
    paths: list[FieldPath] = msgspec.field(default_factory=list)
    problems: list[str] = msgspec.field(default_factory=list)
    """Problems of the paths themselves, whatever the message is."""


class Text(Display):
    """The newest message of any topic as text, in a pane beside the scene."""

    has_pane = True

    topic: Annotated[Topic, Input(ANY), Prop(help="Topic of messages of any type.")] = Topic()
    fields: Annotated[
        list[str],
        Prop(
            help="Paths of the fields that are shown, such as pose.position.x, position[0] or "
            "position[left_wheel]; empty for all."
        ),
    ] = msgspec.field(default_factory=list)
    digits: Annotated[int, Prop(ge=1, le=17, help="Significant digits of numbers.")] = 6
    array_length: Annotated[
        int, Prop(ge=0, le=200, help="Elements that are shown of each array.")
    ] = 20
    update_interval: Annotated[
        float,
        Prop(ge=0, unit="s", help="Minimum time between updates, so that numbers can be read."),
    ] = 0.1

    def new_state(self) -> _State:
        """Return the state before the first message."""
        return _State()

    def waits(self, name: str) -> bool:
        """Text needs no transform."""
        return False

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Find the fields in the newest message."""
        state: _State = ctx.state
        settings = (tuple(self.fields), self.digits, self.array_length)
        if settings != state.settings:
            state.settings, state.pane = settings, None
            self._read_paths(state)
        readout = Readout(
            topic=self.topic.name,
            type=sample.type,
            message=sample.message,
            paths=self._paths(sample, state, ctx),
            received_s=sample.received_ns / SECOND,
            digits=self.digits,
            max_items=self.array_length,
        )
        is_empty = bool(self.fields) and not readout.paths
        state.newest = None if is_empty else Pane(readout, sample.stamp_ns, ctx.order)

    def tick(self, ctx: Context) -> None:
        """Show the newest message, but not too often."""
        state: _State = ctx.state
        since_ns = ctx.frames.now_ns - state.shown_ns
        # ROS time may stand still, or go back.
        is_early = 0 < since_ns < self.update_interval * SECOND
        if state.newest is not state.pane and (state.pane is None or not is_early):
            state.pane, state.shown_ns = state.newest, ctx.frames.now_ns
        if state.pane is not None:
            ctx.add("pane", state.pane)

    def _read_paths(self, state: _State) -> None:
        state.paths, state.problems = [], []
        for text in dict.fromkeys(self.fields[:MAX_FIELDS]):
            try:
                state.paths.append(FieldPath(text))
            except PathError as error:
                state.problems.append(str(error))
        if len(self.fields) > MAX_FIELDS:
            state.problems.append(f"Only the first {MAX_FIELDS} fields are shown.")

    def _paths(self, sample: Sample, state: _State, ctx: Context) -> tuple[FieldPath, ...]:
        """Return the chosen fields that the message has; says which are missing."""
        paths: list[FieldPath] = []
        problems = list(state.problems)
        for path in state.paths:
            try:
                path(sample.message)
                paths.append(path)
            except PathError as error:
                problems.append(str(error))
        more = f" And {len(problems) - 1} more." if len(problems) > 1 else ""
        if not self.fields:
            ctx.ok("Fields", f"All fields of {sample.type}.")
        elif not paths:
            ctx.error("Fields", problems[0] + more)
        elif problems:
            ctx.warn("Fields", problems[0] + more)
        else:
            ctx.ok("Fields", f"{counted(len(paths), 'field')} of {sample.type}.")
        return tuple(paths)
