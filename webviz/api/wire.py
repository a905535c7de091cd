"""Former home of `webviz.api.connection`."""

from webviz.api.connection import GraphConnection, ReceivedMessages
from webviz.api.former_names import former_names

__getattr__ = former_names(__name__, {"Heard": ReceivedMessages, "Wire": GraphConnection})
