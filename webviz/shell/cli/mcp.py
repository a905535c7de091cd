"""`webviz mcp`: lets agents see, ask and act."""

import threading
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import App, Parameter, validators

from webviz.api.errors import Error
from webviz.shell.cli.ending import Stop, until_signal
from webviz.shell.cli.options import ROS_ARGS_HELP, RosArgs
from webviz.shell.cli.terminal import warn
from webviz.shell.cli.viewing_options import BagOptions, ViewingOptions

if TYPE_CHECKING:
    from webviz.shell.app.viewer import Viewer

EXAMPLES = """\
Examples:
  webviz mcp --port 0                  on standard input and output, of the ROS graph
  webviz mcp --bag run.mcap --port 0   of a bag
  webviz mcp --role operator           agents may change displays and use tools, too
  webviz mcp --http 8765               at http://127.0.0.1:8765/mcp, with tokens

With --http each caller sends a token of `webviz token` as `Authorization: Bearer TOKEN` and has its
role. Pages then require tokens, too.

"""
MISSING = "`webviz mcp` needs the package mcp: pip install 'ros-webviz[mcp]'."

app = App("mcp", help_epilogue=EXAMPLES + ROS_ARGS_HELP)


@app.default
def mcp(
    *,
    role: Literal["watcher", "operator", "owner"] = "watcher",
    http: Annotated[
        int | None,
        Parameter(validator=validators.Number(gte=1, lte=65535), metavar="PORT"),
    ] = None,
    bag: BagOptions = BagOptions(),
    options: ViewingOptions = ViewingOptions(),
    ros: RosArgs,
) -> int:
    """Show a robot or a bag to agents, besides the page.

    Args:
        role: What the agent on standard input may do: watcher looks, operator also changes displays
            and uses tools, owner also opens and saves configs.
        http: Serve on this port of 127.0.0.1 instead of standard input and output.
        bag: To play instead of live topics.
        options: Of the viewer.
        ros: Arguments for ROS.
    """
    try:
        import mcp.server.mcpserver  # noqa: F401
    except ImportError:
        raise Error(MISSING) from None
    options = replace(options, token=options.token or http is not None)

    def work(stop: Stop) -> int:
        from webviz.api.roles import Role
        from webviz.shell.agents.agent_tools import AgentTools
        from webviz.shell.agents.caller import AgentCaller
        from webviz.shell.agents.server import HttpServer, serve_stdio
        from webviz.shell.cli.serving import serve

        def answer(viewer: "Viewer") -> None:
            tools = AgentTools(viewer, lambda who, text: viewer.note(who.visitor(), text))
            if http is not None:
                server = HttpServer(tools, viewer.access, "127.0.0.1", http)
                warn(f"webviz: agents at http://127.0.0.1:{http}/mcp")
                threading.Thread(target=server.run, name="webviz-mcp", daemon=True).start()
                return
            warn(f"webviz: the page is at {viewer.url}")

            def talk() -> None:
                serve_stdio(tools, AgentCaller("agent", Role[role.upper()]))
                viewer.stop()  # the program that started this has ended

            threading.Thread(target=talk, name="webviz-mcp", daemon=True).start()

        return serve(options, ros, stop, bag=bag, work=answer)

    return until_signal(work)
