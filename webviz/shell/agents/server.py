"""The server of the Model Context Protocol, on standard input and output or over HTTP."""

from __future__ import annotations

import functools
import io
from collections.abc import Awaitable, Callable, MutableMapping
from contextvars import ContextVar
from typing import Any

import anyio
import PIL.Image
import uvicorn
from mcp.server.mcpserver import Image, MCPServer
from mcp.server.mcpserver.exceptions import ToolError
from mcp.server.transport_security import TransportSecuritySettings
from mcp.types import ToolAnnotations

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.server.access.access import Access
from webviz.shell.agents.agent_tools import AgentTools, command_names
from webviz.shell.agents.caller import AgentCaller
from webviz.shell.pictures.browser import Pixels

INSTRUCTIONS = """\
A viewer of a ROS 2 robot. Call `explain` first: it says what is wrong, why, and how to repair it.
`see` makes pictures, which takes seconds. `act` changes the viewer, or commands the robot with
UseTool.
"""
ACT = """\
Run a command, as far as the role of this connection allows. Examples:
SetProperty {"display": "display3", "path": "size", "value": 0.05}; `explain` lists the ids
AddDisplay {"type": "LaserScan", "values": {"topic": "/scan"}}
SetFixedFrame {"frame": "odom"}
UseTool {"tool": "2D Goal Pose", "points": [[1.0, 2.0, 0.0]], "yaw": 1.57}
Seek {"at_s": 12.5}
All commands: """
READS = ToolAnnotations(read_only_hint=True)
ACTS = ToolAnnotations(read_only_hint=False)
SHARPNESS = 80
"""Quality of pictures, which are WebP."""

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Any]]
Send = Callable[[Any], Awaitable[None]]


def serve_stdio(tools: AgentTools, caller: AgentCaller) -> None:
    """Answer on standard output what comes on standard input, until that ends."""
    make_server(tools, lambda: caller).run("stdio")


class HttpServer:
    """Answers at `/mcp`, each caller with the role of its token.

    Args:
        tools: what callers use.
        access: knows the tokens.
        host: address to listen on.
        port: to listen on.
    """

    def __init__(self, tools: AgentTools, access: Access, host: str, port: int) -> None:
        self._caller: ContextVar[AgentCaller] = ContextVar("caller")
        self._access = access
        app = make_server(tools, self._caller.get).streamable_http_app(
            stateless_http=True,
            transport_security=TransportSecuritySettings(
                allowed_hosts=[f"{name}:{port}" for name in ("127.0.0.1", "localhost", host)]
            ),
        )
        self._app = app
        self._server = uvicorn.Server(
            uvicorn.Config(
                self._authenticate,
                host,
                port,
                interface="asgi3",
                log_level="warning",
                lifespan="on",
            )
        )

    def run(self) -> None:
        """Serve until `stop`."""
        self._server.run()

    def stop(self) -> None:
        """End `run`, from any thread."""
        self._server.should_exit = True

    async def _authenticate(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] == "http":
            caller = self._caller_of(scope)
            if caller is None:
                await _refuse(send)
                return
            self._caller.set(caller)
        await self._app(scope, receive, send)

    def _caller_of(self, scope: Scope) -> AgentCaller | None:
        """Return the caller that a request's token belongs to."""
        headers = dict(scope["headers"])
        kind, _, secret = headers.get(b"authorization", b"").decode("latin-1").partition(" ")
        grants = (self._access.by_secret(secret.strip(), role) for role in Role)
        grant = next((each for each in grants if each is not None), None)
        if kind.lower() != "bearer" or grant is None:
            return None
        host = (scope.get("client") or ("",))[0]
        return AgentCaller(grant.name, grant.role, host)


async def _refuse(send: Send) -> None:
    text = b"Send a token of this viewer: `Authorization: Bearer TOKEN`; `webviz token` lists them."
    headers = [(b"content-type", b"text/plain"), (b"www-authenticate", b"Bearer")]
    await send({"type": "http.response.start", "status": 401, "headers": headers})
    await send({"type": "http.response.body", "body": text})


def make_server(tools: AgentTools, caller: Callable[[], AgentCaller]) -> MCPServer[Any]:
    """Return a server of tools.

    Args:
        tools: what they do.
        caller: that of the call that is answered.
    """
    server: MCPServer[Any] = MCPServer("webviz", instructions=INSTRUCTIONS, log_level="WARNING")

    async def called(work: Callable[..., Any], *args: Any) -> Any:
        """Work in a thread, since viewers take seconds; their errors are for agents, too."""
        try:
            return await anyio.to_thread.run_sync(functools.partial(work, caller(), *args))
        except Error as error:
            raise ToolError(str(error)) from error

    @server.tool(annotations=READS)
    async def explain(display: str = "") -> str:
        """Find out why something is not shown or wrong: causes first, with remedies and commands to
        type, then the status of each display (or of one, by name). Takes about 3 seconds."""
        return await called(tools.explain, display)

    @server.tool(annotations=READS, structured_output=False)
    async def see(
        views: list[str | dict[str, Any] | None] | None = None,
        width: int = 800,
        height: int = 600,
    ) -> list[Image]:
        """Pictures of the scene with camera images beside it. Each view is null for the start view,
        the name of a saved one, or values such as {"type": "Orbit", "distance": 5, "yaw": 0.8,
        "pitch": 0.8, "focal_point": [0, 0, 0]} or {"type": "TopDownOrtho", "scale": 50}."""
        images = await called(tools.see, views or [None], width, height)
        return [_encoded(each) for each in images]

    @server.tool(annotations=READS)
    async def select(
        x: int,
        y: int,
        view: str | dict[str, Any] | None = None,
        width: int = 800,
        height: int = 600,
    ) -> str:
        """Select at a pixel of the picture that `see` makes of this view and size: returns the
        link, frame, point, cell or marker there with its values."""
        return await called(tools.select, x, y, view, width, height)

    @server.tool(annotations=READS)
    async def topics() -> str:
        """All topics with types, publishers and rates."""
        return await called(tools.topics)

    @server.tool(annotations=READS)
    async def read(topic: str) -> str:
        """Return the newest message of a topic, a field a line; long arrays are shortened."""
        return await called(tools.read, topic)

    @server.tool(annotations=READS)
    async def transform(target: str, source: str) -> str:
        """Return the newest pose of frame `source` in frame `target`, or why it is unknown."""
        return await called(tools.transform, target, source)

    async def act(command: str, fields: dict[str, Any] | None = None) -> str:
        return await called(tools.act, command, fields or {})

    server.tool(description=ACT + ", ".join(sorted(command_names())) + ".", annotations=ACTS)(act)
    return server


def _encoded(pixels: Pixels) -> Image:
    file = io.BytesIO()
    PIL.Image.fromarray(pixels).save(file, "WEBP", quality=SHARPNESS)
    return Image(data=file.getvalue(), format="webp")
