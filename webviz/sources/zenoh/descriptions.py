"""Definitions of types that this machine does not know, from the nodes that publish them.

Nodes of Jazzy and later have the service `~/get_type_description` (REP 2016), which returns the
texts from which their types were built, unless they were started without it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future

from webviz.data.messages import MessageError, decode, encode, interfaces, type_exists
from webviz.sources.graph import NotConnected
from webviz.sources.zenoh.calls import ZenohCalls
from webviz.sources.zenoh.discovered import GraphSnapshot

UNDEFINED = (
    "the definition of {type} is unknown here, and its publisher does not provide it. Source the "
    "workspace that has its package before starting webviz"
)
SERVICE = "type_description_interfaces/srv/GetTypeDescription"
REQUEST = "string type_name\nstring type_hash\nbool include_type_sources\n"
RESPONSE = """bool successful
string failure_reason
TypeDescription type_description
TypeSource[] type_sources
KeyValue[] extra_information
"""
TIMEOUT_S = 5.0
MAX_SOURCES = 1000
MAX_ASKED = 1000
"""Topics whose definition was asked for."""


class TypeDescriptions:
    """Asks publishers for the definitions of their types, once each.

    Args:
        calls: of services.
        learn: takes topic, type and definition; called in threads of the engine.
    """

    def __init__(self, calls: ZenohCalls, learn: Callable[[str, str, str], None]) -> None:
        self._calls = calls
        self._learn = learn
        self._requests = set[tuple[str, str]]()

    def ask(self, types: Mapping[str, str], graph: GraphSnapshot) -> None:
        """Ask for what is unknown of these types by topic, unless their publishers were asked."""
        for topic, type in types.items():
            if type_exists(type):
                continue
            for publisher in graph.publishers.get(topic, ()):
                service = f"{publisher.node}/get_type_description"
                server = graph.servers.get(service)
                is_known = server is not None and server.type == SERVICE
                key = topic, publisher.node
                if publisher.type == type and is_known and key not in self._requests:
                    if len(self._requests) >= MAX_ASKED:
                        return
                    self._requests.add(key)
                    self._ask(topic, type, service, publisher.hash)

    def _ask(self, topic: str, type: str, service: str, hash: str) -> None:
        interfaces.learn(SERVICE, REQUEST, RESPONSE)
        values = {"type_name": type, "type_hash": hash, "include_type_sources": True}
        request = encode(f"{SERVICE}_Request", values)
        answer: Future[bytes] = Future()

        def take(answered: Future[bytes]) -> None:
            try:
                text = definition_in(type, answered.result())
            except (NotConnected, MessageError):
                return
            if text:
                self._learn(topic, type, text)

        answer.add_done_callback(take)
        self._calls.send(service, SERVICE, request, TIMEOUT_S, answer)


def definition_in(type: str, response: bytes) -> str:
    """Return the definition of a type in a response, as `register` reads it; "" for none.

    Raises:
        MessageError: the response is malformed.
    """
    answer = decode(f"{SERVICE}_Response", response)
    sources = answer.type_sources
    if not answer.successful or len(sources) > MAX_SOURCES:
        return ""
    texts = {each.type_name: each.raw_file_contents for each in sources if each.encoding == "msg"}
    if type not in texts or len(texts) != len(sources):
        return ""
    parts = [texts.pop(type)]
    for name, text in texts.items():
        package, _, base = name.split("/") if name.count("/") == 2 else ("", "", "")
        parts.append(f"MSG: {package}/{base}\n{text}")
    return f"\n{'=' * 80}\n".join(parts)
