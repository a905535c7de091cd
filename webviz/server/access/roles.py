"""Links and limits of the roles of those who open the page."""

from __future__ import annotations

import msgspec

from webviz.api.roles import Role

LINKS = {"watch": Role.WATCHER, "operate": Role.OPERATOR, "own": Role.OWNER}
"""The parameter of a link that carries a token, by which people see what the link is for."""


class Limits(msgspec.Struct, frozen=True):
    """Limits of one connection.

    Args:
        share: of all connections that there may be, as far as connections of this role and of those
            below it together may fill them: many watchers cannot keep the owner out.
        per_address: browsers from one network address.
        messages_per_second: received from it on average; a page sends 50 while the user drags
            something.
        bytes_per_message: each further multiple of this size counts as one more message. Reading
            JSON delays the driver: what watchers send at most takes little of a processor.
        max_characters: of one message; the longest of watchers are selections, of owners configs.
        max_values: of one message, counted by its commas and brackets before it is read: lists of
            lists take a hundred times as long as a text of that length. A selection of a thousand
            things has 11 000, and the text of a config as many as it has characters.
    """

    share: float
    per_address: int
    messages_per_second: float
    bytes_per_message: int
    max_characters: int
    max_values: int


LIMITS = {
    Role.WATCHER: Limits(0.75, 16, 100.0, 1 << 10, 256 << 10, 20_000),
    Role.OPERATOR: Limits(0.9, 32, 200.0, 32 << 10, 1 << 20, 200_000),
    Role.OWNER: Limits(1.0, 128, 200.0, 32 << 10, 3 << 20, 3 << 20),
}
