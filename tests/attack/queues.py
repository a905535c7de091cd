"""Commands of lower roles that fill queues, while the owner saves."""

from __future__ import annotations

from random import Random

import msgspec
import websockets.exceptions

from tests.attack.attack import Attack, Case, Outcome, Violation
from tests.attack.target import ANSWER_S, Target
from tests.attack.visitor import Visitor
from webviz.api.roles import Role

COMMANDS = ("Export", "WriteDisplays", "Identify", "FocusFrame", "ResetView")
"""Commands that a watcher may send: two wait for a thread, the others for the frame loop."""
ARGUMENTS = {
    "WriteDisplays": {"displays": ["display1", "display2"]},
    "Identify": {"picks": {"group": "g", "key": "k", "items": []}},
    "FocusFrame": {"frame": "map"},
}
BURST = 200
"""Messages that a watcher may send at once."""


class Flood(msgspec.Struct):
    """A case.

    Args:
        commands: of each watcher, sent in turn.
    """

    commands: list[list[str]]


class Queues(Attack):
    """Sends bursts of commands of watchers, upon which the owner has to be able to save.

    Args:
        target: the viewer.
    """

    kind = "queues"

    def __init__(self, target: Target) -> None:
        self._target = target
        self._visitors: list[Visitor] = []

    def draw(self, random: Random) -> Case:
        kinds = random.sample(COMMANDS, random.randint(1, 3))
        sizes = [random.randint(1, BURST) for _ in range(random.randint(1, 4))]
        flood = Flood([[random.choice(kinds) for _ in range(size)] for size in sizes])
        return Case("flood.json", msgspec.json.encode(flood))

    def strike(self, case: Case) -> Outcome:
        flood = msgspec.json.decode(case.data, type=Flood)
        watchers: list[Visitor] = []
        owner = self._visitor(Role.OWNER)
        try:
            for each in flood.commands:
                watchers.append(self._visitor(Role.WATCHER))
                for number, command in enumerate(each):
                    arguments = ARGUMENTS.get(command, {})
                    watchers[-1].send(
                        "CommandRequest", number=number, command=command, arguments=arguments
                    )
            level, text = owner.do("Save", ANSWER_S, path="flooded.yaml")
        except TimeoutError as error:
            raise Violation(f"the owner's save has no answer within {ANSWER_S:g} s") from error
        except (websockets.exceptions.WebSocketException, ConnectionError) as error:
            raise Violation(f"a page was disconnected: {error!r}") from error
        finally:
            self.close()
        if level == "error":
            raise Violation(f"watchers keep the owner from saving: {text}")
        return Outcome.DONE

    def close(self) -> None:
        while self._visitors:
            self._visitors.pop().close()

    def _visitor(self, role: Role) -> Visitor:
        self._visitors.append(self._target.visitor(role))
        return self._visitors[-1]
