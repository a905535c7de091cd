"""Table of everything that reaches into viser: private parts of its server, and of its page.

`test_viser_parts.py` checks that it is complete. The tests of each row are in `test_adapter.py`,
`test_sender.py`, `test_primitives.py` and `test_viser_page.py`, which fail with another viser.
"""

from __future__ import annotations

from typing import NamedTuple


class Reach(NamedTuple):
    """A place that depends on a private part of viser.

    Args:
        file: below the repository.
        parts: names in that file: modules, attributes, and for JavaScript what is replaced.
        why: what it serves.
        upstream: what viser would need, so that the row can go.
    """

    file: str
    parts: tuple[str, ...]
    why: str
    upstream: str


ADAPTER = "webviz/scene/adapter"
HTTP = "webviz/server/http"
PAGE = "webviz/page/web"

SERVER: tuple[Reach, ...] = (
    Reach(
        f"{ADAPTER}/acknowledging.py",
        ("viser._messages", "_websock_server", "_websock_connection"),
        "wait until all browsers have applied what was sent",
        "an acknowledgement of messages by the page",
    ),
    Reach(
        f"{ADAPTER}/greeting.py",
        (
            "viser._messages",
            "viser.infra._infra.ClientId",
            "viser.infra._infra.WebsockClientConnection",
            "_websock_server",
            "_live_connections",
        ),
        "one life of viser's connection and of the channel, and the end of a visit",
        "public access to the connection of a client, and a way to close it",
    ),
    Reach(
        f"{ADAPTER}/image.py",
        ("viser._messages", "_make", "_websock_server"),
        "encoded images, and a background of one colour, without importing imageio",
        "`add_image` with encoded bytes, and a background by colour",
    ),
    Reach(
        f"{ADAPTER}/link.py",
        (
            "viser._assignable_props_api.AssignablePropsBase",
            "viser._messages",
            "viser.infra._messages._prepare_for_serialization",
            "_impl",
            "_live_connections",
            "_prop_hints",
            "_run_garbage_collector",
            "_state",
            "_websock_server",
        ),
        "poses and properties in one message, cameras in one piece, bounded removals, nodes made "
        "in a fraction of the time, arrays packed without a look at the type of each value",
        "a public queue of messages, snapshots of cameras, removals that end, and a cache of "
        "`get_type_hints`",
    ),
    Reach(
        f"{ADAPTER}/tape.py",
        (
            "viser._messages",
            "viser.infra._infra.ClientId",
            "viser.infra._messages.Message",
            "_websock_server",
        ),
        "runs as one file: what a browser that joins would be sent, and what has changed since",
        "a serializer that also has poses that were queued apart",
    ),
    Reach(
        f"{ADAPTER}/poses.py",
        ("viser._messages", "viser.infra._async_message_buffer.AsyncMessageBuffer"),
        "hundreds of poses per turn under one lock",
        "a call that places many nodes",
    ),
    Reach(
        f"{ADAPTER}/sender.py",
        (
            "viser.infra._async_message_buffer.AsyncMessageBuffer",
            "viser.infra._messages.Message",
            "_window_loop",
        ),
        "small messages first, large ones by the pace of each link, packed once, quick joins",
        "a sender that can be exchanged",
    ),
    Reach(
        f"{HTTP}/viser_messages.py",
        ("viser._messages",),
        "checks of what browsers send before viser reads it",
        "validation of messages in viser",
    ),
    Reach(
        f"{HTTP}/viser_page.py",
        ("document.currentScript.dataset",),
        "our modules run before viser's own script",
        "a hook for scripts and style sheets of the page",
    ),
)

CLIENT: tuple[Reach, ...] = (
    Reach(
        f"{PAGE}/viser_page.js",
        ("__viserMutable", "__r3f", "Worker.prototype.postMessage", "history.replaceState"),
        "all access to the scene, the camera, the queue of messages and the renderer",
        "an object with these for scripts of the page, and an address of the server",
    ),
    Reach(
        f"{PAGE}/globals.d.ts",
        ("__viserMutable",),
        "its declaration for the type checker",
        "types of that object",
    ),
    Reach(
        f"{PAGE}/scene/colors.js",
        ("fragmentShader", "onBeforeCompile"),
        "meshes with a colour for each vertex",
        "`add_mesh_simple` with colours of vertices",
    ),
    Reach(
        f"{PAGE}/scene/flat.js",
        ("vertexShader", "onBeforeCompile"),
        "sheets in their exact colour over lines of their plane",
        "unlit meshes with an offset of depth",
    ),
    Reach(
        f"{PAGE}/scene/labels.js",
        ("vertexShader", "fragmentShader"),
        "texts with a colour and an outline, without a box",
        "`add_label` with a colour and an outline",
    ),
    Reach(
        f"{PAGE}/scene/lines.js",
        ("vertexShader", "fragmentShader"),
        "lines with an opacity, square ends and mitred joints",
        "`add_line_segments` with an opacity, ends and joints",
    ),
    Reach(
        f"{PAGE}/scene/points.js",
        ("vertexShader", "fragmentShader"),
        "points with an opacity, and of sizes that grow with the depth",
        "`add_point_cloud` with an opacity, and a size for each point",
    ),
    Reach(
        f"{PAGE}/scene/shade.js",
        ("vertexShader", "fragmentShader", "onBeforeCompile"),
        "shading as by the one light of RViz",
        "a light that shines from the camera, added up in sRGB",
    ),
    Reach(
        f"{PAGE}/scene/tiles.js",
        ("vertexShader", "onBeforeCompile"),
        "maps behind the lines and meshes of their plane",
        "images with an offset of depth",
    ),
    Reach(
        f"{PAGE}/scene/view.js",
        ("Raycaster().prototype",),
        "picking in views without perspective that reverse the depth",
        "three.js with a ray that knows reversed depth",
    ),
)
