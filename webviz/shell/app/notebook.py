"""Viewers in the cells of notebooks: Jupyter, VS Code and marimo."""

from __future__ import annotations

import re
import sys
from collections.abc import Sequence

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.server.access.access import Access
from webviz.server.access.starting import link
from webviz.server.access.tokens import role_of

KERNELS = ("ipykernel", "marimo")
"""Modules of which one is loaded in a notebook."""
OF_NOTEBOOKS = ("http://localhost:*", "http://127.0.0.1:*", "vscode-webview:")
"""Origins of notebooks of this machine."""
ORIGIN = re.compile(r"[a-z][a-z0-9+.-]*:(//[\w.*:\[\]-]+)?")
HEIGHT = 600
"""Height of the page in pixels."""


def embedders(origins: Sequence[str] | None) -> Sequence[str]:
    """Return the origins of pages that may embed a viewer.

    Args:
        origins: as given; None for notebooks of this machine, if this program is one.

    Raises:
        Error: one is no origin.
    """
    if origins is None:
        return OF_NOTEBOOKS if any(name in sys.modules for name in KERNELS) else ()
    for each in origins:
        if not ORIGIN.fullmatch(each):
            raise Error(f"`{each}` is not the origin of a page, such as http://localhost:8888.")
    return origins


def html(page: str, access: Access, is_embeddable: bool) -> str:
    """Return a page of a viewer on this machine, or a link to it if it may not be embedded.

    Args:
        page: its address.
        access: knows the tokens.
        is_embeddable: whether notebooks may embed it.
    """
    url = page.replace("//127.0.0.1:", "//localhost:")  # the site of notebooks: with cookies
    if access.asks:
        # Notebooks are saved with what cells show: this link must not let anybody act. Without a
        # watcher's token, the page asks for one.
        tokens = [token for token in access.tokens if role_of(token) is Role.WATCHER]
        url = link(url, tokens[0]) if tokens else url
    from html import escape  # here, as its entities take 0.5 MB

    address = escape(url, quote=True)
    if not is_embeddable:
        return f'<a href="{address}" target="_blank">{escape(page)}</a>'
    style = f"width: 100%; height: {HEIGHT}px; border: 0"
    return f'<iframe src="{address}" style="{style}" title="webviz"></iframe>'
