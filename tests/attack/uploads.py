"""Configs that pages open from the computer of their user: names, sizes, many at once, endless."""

from __future__ import annotations

import contextlib
import threading
from random import Random

import msgspec
import websockets.exceptions

from tests.attack.attack import Attack, Case, Outcome, Violation
from tests.attack.target import ANSWER_S, Target
from webviz.api.roles import Role

NAMES = (
    "a.yaml", "../a.yaml", "/etc/passwd", "a/b.yaml", "..", "", "\x00.yaml", "a" * 300 + ".yaml",
    "\u202eyaml.a", "a.rviz", "a.yaml\n", "CON.yaml", "\N{SNOWMAN}.yaml", "-rf.yaml", ".yaml",
)  # fmt: skip
BODIES = (
    "", "version: 1\n", "[", "a: &a [*a]", "&a {<<: *a}", "? {a: b}\n",
    "!!python/object:os.system x",
    "displays: [{type: Grid, color: [1, 2]}]", "displays:\n" + "- {type: Grid}\n" * 300,
    "x: " + "[" * 5000, "\x00", "\ufeffversion: 1", "displays: [{type: Grid, cell_count: 1e308}]",
    "a: &a [x,x]\nb: &b [*a,*a]\nc: &c [*b,*b]\nd: [*c,*c]\n", "Visualization Manager: {}",
)  # fmt: skip
PARALLEL = 6
ENDLESS_S = 1.0
"""Time in seconds for which a message goes on that never ends."""


class Uploads(Attack):
    """Opens configs with the command of pages.

    Args:
        target: the viewer.
    """

    kind = "uploads"

    def __init__(self, target: Target) -> None:
        self._target = target

    def draw(self, random: Random) -> Case:
        name, body = random.choice(NAMES), random.choice(BODIES)
        if random.random() < 0.2:
            body += "# " + "x" * random.choice((10_000, 1_900_000, 2_100_000, 3_500_000))
        how = random.choice(("one", "one", "one", "many", "endless"))
        command = random.choice(("Load", "Load", "Load", "Save", "Open"))
        arguments = {"text": body, "name": name} if command == "Load" else {"path": name}
        text = {"type": "CommandRequest", "number": 1, "command": command, "arguments": arguments}
        return Case(f"{how}.json", msgspec.json.encode(text))

    def strike(self, case: Case) -> Outcome:
        how = case.name.partition(".")[0]
        if how == "many":
            return self._many(case)
        visitor = self._target.visitor(Role.OWNER)
        try:
            if how == "endless":
                visitor.say_endlessly(case.data.decode(), ENDLESS_S)
                return Outcome.REFUSED
            visitor.say(case.data.decode())
            level, _ = visitor.answer(1, ANSWER_S)
            return Outcome.REFUSED if level == "error" else Outcome.DONE
        except (websockets.exceptions.WebSocketException, EOFError, ConnectionError):
            return Outcome.REFUSED
        except TimeoutError as error:
            raise Violation(f"no answer within {ANSWER_S:g} s") from error
        finally:
            visitor.close()

    def _many(self, case: Case) -> Outcome:
        results: list[Outcome | Violation] = []

        def strike() -> None:
            with contextlib.suppress(OSError):
                try:
                    results.append(self.strike(Case("one.json", case.data)))
                except Violation as violation:
                    results.append(violation)

        threads = [threading.Thread(target=strike) for _ in range(PARALLEL)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        for each in results:
            if isinstance(each, Violation):
                raise each
        return Outcome.DONE if Outcome.DONE in results else Outcome.REFUSED
