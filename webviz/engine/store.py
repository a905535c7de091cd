"""The base of stores: values by key that pages watch."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

import msgspec


class PageStore(msgspec.Struct, frozen=True):
    """A store. Each field is a key; one that is unset is missing.

    The types of the page's modules are generated from these classes.
    """

    spread: ClassVar[Mapping[str, str]] = {}
    """The fields whose items are keys of their own, with the prefix of these keys."""

    def by_key(self) -> dict[str, Any]:
        """Return the values by key, as `webviz.server.channel.stores` compares them."""
        fields: dict[str, Any] = {}
        for name, key in zip(self.__struct_fields__, self.__struct_encode_fields__, strict=True):
            value = getattr(self, name)
            prefix = self.spread.get(name)
            if prefix is None:
                if value is not msgspec.UNSET:
                    fields[key] = value
            elif prefix:
                fields |= {f"{prefix}{item}": each for item, each in value.items()}
            else:
                fields |= value
        return fields
