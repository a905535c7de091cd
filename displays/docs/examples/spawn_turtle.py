"""A tool that calls a service with the point that is clicked."""

from webviz import Gesture, Tool, ToolContext


class SpawnTurtle(Tool):
    """Spawn a turtle of turtlesim: click on its position."""

    title = "Spawn Turtle"
    shortcut = "t"
    service: str = "/spawn"

    @property
    def uses(self) -> tuple[str, ...]:
        """The service, which the list `publish` of a config may leave out."""
        return (self.service,)

    def done(self, gesture: Gesture, ctx: ToolContext) -> None:
        """Call the service, and report the name of the turtle."""
        x, y, _ = gesture.position
        srv = "float32 x\nfloat32 y\nfloat32 theta\nstring name\n---\nstring name"
        ctx.call(
            self.service,
            "turtlesim/srv/Spawn",
            {"x": x, "y": y},
            definition=srv,
            answered=lambda response: ctx.ok(f"Spawned {response.name}."),
        )
