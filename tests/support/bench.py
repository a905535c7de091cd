"""A viewer without ROS and browser: a source fed by hand and a scene that remembers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from contextlib import AbstractContextManager
from pathlib import Path
from typing import Any, TypeVar

from several import several
from waiting import until

from webviz.api.display import Display
from webviz.api.nodes import Node
from webviz.data.messages import encode
from webviz.engine.commands import PROGRAM, Command, Sender
from webviz.engine.loop import FrameLoop
from webviz.engine.parts import Part, PartContext
from webviz.engine.pipeline.scene import Cameras, NoCameras
from webviz.engine.state import State
from webviz.files.config import Config, Item, Settings
from webviz.files.config.model import MemorySettings
from webviz.shell.testing.messages import header, stamped_transform
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource
from webviz.sources.player import Player

N = TypeVar("N", bound=Node)
D = TypeVar("D", bound=Display)


class Bench:
    """A viewer on a hand-fed source, or the recording of a player, and a recording scene."""

    def __init__(
        self,
        *displays: Item,
        fixed_frame: str = "map",
        strict: bool = True,
        autosave: Path | None = None,
        path: Path | None = None,
        session: Path | None = None,
        restore: bool = True,
        cameras: Cameras | None = None,
        scene: RecordingScene | None = None,
        parts: Sequence[Callable[[PartContext], Part]] = (),
        publish: tuple[str, ...] | None = ("/*",),
        allow_publish: Sequence[str] = (),
        may_publish: bool = True,
        graph: Any = None,
        robots: tuple[str, ...] = (),
        memory: MemorySettings | None = None,
        player: Player | None = None,
    ) -> None:
        self.source = HandFedSource(**({"graph": graph} if graph else {}))
        self.scene = scene or RecordingScene(cameras=cameras or NoCameras())
        self.states: list[State] = []
        self.clock = 1000.0
        settings = Settings(fixed_frame=fixed_frame, publish=publish, robots=robots)
        settings.memory = memory or settings.memory
        config = Config(settings, list(displays))
        self.viewer = FrameLoop(
            config,
            player or self.source,
            self.scene,
            self._note_state,
            may_publish=may_publish,
            allow_publish=allow_publish,
            autosave=autosave,
            path=path,
            session=session,
            restore=restore,
            parts=parts,
            strict=strict,
            clock=lambda: self.clock,
        )
        self.turn()

    def _note_state(self) -> None:
        """Note what panels show."""
        self.states.append(self.viewer.last_state())

    def publish(self, topic: str, type_name: str, values: Mapping[str, Any]) -> None:
        self.source.put(topic, type_name, encode(type_name, values))

    def transform(
        self,
        parent: str,
        child: str,
        stamp_ns: int,
        x: float = 0.0,
        *,
        static: bool = False,
        topic: str = "",
    ) -> None:
        stamped = stamped_transform(parent, child, stamp_ns, (x, 0.0, 0.0))
        topic = topic or ("/tf_static" if static else "/tf")
        self.publish(topic, "tf2_msgs/msg/TFMessage", {"transforms": [stamped]})

    def pose(self, topic: str, frame: str, stamp_ns: int, x: float = 0.0) -> None:
        pose = {"position": {"x": x}, "orientation": {"w": 1.0}}
        values = {"header": header(frame, stamp_ns), "pose": pose}
        self.publish(topic, "geometry_msgs/msg/PoseStamped", values)

    @property
    def graph(self) -> RememberingGraph:
        """The graph of a bench that was given one."""
        assert isinstance(self.source.graph, RememberingGraph)
        return self.source.graph

    def nodes(self, kind: type[N], display: str = "") -> list[N]:
        """The visible nodes of a kind, of all displays or of one by its id."""
        return [node for _, _, node in self.scene.visible(display) if isinstance(node, kind)]

    def display(self, kind: type[D]) -> D:
        """The first display of a kind."""
        displays = (row.display for row in self.viewer.state().rows)
        return next(display for display in displays if isinstance(display, kind))

    def turn(self, keep_up: bool = False) -> None:
        self.viewer.turn(keep_up)

    def do(self, command: Command, sender: Sender = PROGRAM) -> State:
        """Run a command and return the state that panels show."""
        self.until_done(self.viewer.enqueue(command, sender))
        return self.states[-1]

    def ask(self, command: Command) -> str:
        """The answer to a command."""
        answer = self.viewer.enqueue(command)
        self.until_done(answer)
        return answer.result(0)

    def refusal(self, command: Command) -> str:
        """Return why a command is refused."""
        answer = self.viewer.enqueue(command)
        self.until_done(answer)
        return str(answer.exception(0))

    def until_done(self, answer: Future[str]) -> None:
        """Turn until a command is done; one about files takes several turns."""
        self.turn()
        until(answer.done, turn=self.turn)

    def statuses(self, index: int = 0) -> dict[str, tuple[str, str]]:
        """Level and sentence by key of one display, as a panel would show them now."""
        self.turn(keep_up=True)
        row = self.states[-1].rows[index]
        return {key: (status.level.name, status.text) for key, status in row.statuses.items()}


Benches = Callable[..., Bench]
"""The fixture `bench`, which makes a `Bench`."""


def benches() -> AbstractContextManager[Benches]:
    """Make benches, and end them all."""
    return several(Bench, lambda bench: bench.viewer.close())
