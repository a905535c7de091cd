"""The panel Motion Planning Tasks: the stages of a task, and which solution is played."""

from __future__ import annotations

from collections.abc import Sequence

from webviz.api.panel import Panel, Send, Ui
from webviz.commands import SetProperty
from webviz.engine.state import Row

DISPLAY = "MotionPlanningTasks"
NEWEST = "Newest"
MISSING = "No display MotionPlanningTasks. Add one to see the stages of a task."
WAITING = "No task received. Start a program that plans with MoveIt Task Constructor."


class MotionPlanningTasks(Panel):
    """The stages that the first display of planning tasks knows, and its solution to play."""

    title = "Planning Tasks"
    rviz = "moveit_task_constructor/Motion Planning Tasks"
    opens = "side"
    icon = "list"

    def build(self, ui: Ui, send: Send) -> None:
        """Build the list of solutions and the table of stages."""
        self.send = send
        self.display = ""
        self.ids: dict[str, int] = {}
        self.choice = ui.choice(
            "Solution", NEWEST, self._choose, "Solution to play, the cheapest of a stage first."
        )
        self.stages = ui.area()

    def show(self, rows: Sequence[Row]) -> None:
        """Show the stages of the first display."""
        row = next((row for row in rows if row.type == DISPLAY and row.display), None)
        if row is None:
            self.display, self.ids = "", {}
            self.choice.offer([NEWEST], NEWEST)
            self.stages.text(MISSING)
            return
        self.display, self.ids = row.id, {NEWEST: 0, **row.offered.get("solution", {})}
        by_id = {id: name for name, id in self.ids.items()}
        chosen = getattr(row.display, "solution", 0)
        self.choice.offer(list(self.ids), by_id.get(chosen, str(chosen)))
        solved, failed = row.offered.get("stages", {}), row.offered.get("failed", {})
        if not solved:
            self.stages.text(WAITING)
            return
        stages = [(name, str(count), str(failed.get(name, 0))) for name, count in solved.items()]
        self.stages.table([("Stage", "Solutions", "Failed"), *stages])

    def _choose(self, name: str, browser: int | None) -> None:
        if self.display and name in self.ids:
            self.send(SetProperty(self.display, "solution", self.ids[name]), browser)
