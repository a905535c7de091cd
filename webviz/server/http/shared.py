"""The last file that an owner has shared, for browsers of owners to download."""

from __future__ import annotations

import http

from webviz.api.roles import Role
from webviz.server.http.requests import is_upgrade
from webviz.server.http.steps import HTML, Reply, RequestContext

PATH = "/shared"
NONE = b"No file has been shared. Choose Share this moment in the menu.\n"
OWNER_ONLY = b"Not allowed: shared files need the link of an owner.\n"


class SharedFile:
    """Keeps one file in memory: a disk that hangs may not hold up the server."""

    def __init__(self) -> None:
        self._name = ""
        self._data = b""

    def offer(self, name: str, data: bytes) -> None:
        """Serve a file in place of the one before; from any thread.

        Args:
            name: of the file, without characters that a header would have to escape.
            data: a page.
        """
        self._name, self._data = name, data

    def step(self, context: RequestContext) -> Reply | None:
        """Serve the file; see `webviz.server.http.steps`."""
        if context.path != PATH or is_upgrade(context.request):
            return None
        if context.grant.role < Role.OWNER:
            return Reply(http.HTTPStatus.FORBIDDEN, OWNER_ONLY)
        if not self._data:
            return Reply(http.HTTPStatus.NOT_FOUND, NONE)
        disposition = f'attachment; filename="{self._name}"'
        headers = {"Content-Type": HTML, "Content-Disposition": disposition}
        return Reply(http.HTTPStatus.OK, self._data, {**headers, "Cache-Control": "no-store"})
