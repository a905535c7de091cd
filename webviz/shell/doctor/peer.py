"""The other machine of `webviz doctor --peer`, and the measurements between both."""

from __future__ import annotations

import contextlib
import ipaddress
import json
import secrets
import shlex
import subprocess
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any, Protocol, TypeVar

import msgspec

from webviz.api.environment import NetworkInterface
from webviz.api.errors import Error
from webviz.api.two_ends import End, NodeProcess, PacketLink, TwoEnds
from webviz.shell.doctor import peer_program
from webviz.shell.doctor.peer_program import MARK, Agent

BOOT = "import sys; i = sys.stdin; exec(i.read(int(i.readline()))); serve()"
"""Start of the other Python: runs the program that follows on its standard input."""
PYTHON = f"exec python3 -u -c {shlex.quote(BOOT)}"
GROUP = "239.255.0.1"
"""Multicast group of DDS."""
FIRST_PORT, PER_DOMAIN, LAST = 7400, 250, 249
"""Ports of DDS: those of a domain, of which participants take the first ones."""
ROUND_TRIPS = 21
SIZES = (9000, 1500, 1480, 1450, 1420, 1400, 1372, 1300, 1280, 1000, 576)
"""Bytes of packets to try."""
HEADERS = 28
"""Bytes of the headers of IPv4 and UDP."""
ARRIVAL_S = 1.0
"""Time for packets to arrive."""
MAX_ADDRESSES = 8
MAX_LINE = 4 << 20

LONGEST_S = 60.0
"""Time in seconds for the whole examination, after which a peer that does not answer is given
up."""

T = TypeVar("T")
Progress = Callable[[str, float], object]


class _Answer(msgspec.Struct):
    value: Any = None
    error: str = ""


class _Interface(msgspec.Struct):
    name: str
    addresses: list[tuple[str, str]]
    has_multicast: bool
    is_loopback: bool
    mtu: int


class _Looked(msgspec.Struct):
    """The result of `Agent.look`."""

    host: str
    python: str
    distributions: list[str]
    variables: dict[str, str]
    nodes: list[NodeProcess]
    interfaces: list[_Interface]
    receive_buffer: int


class _Heard(msgspec.Struct):
    """One item of `Agent.heard`."""

    senders: list[str]
    sizes: list[int]


class PeerError(Error):
    """The other machine cannot be examined."""


class _Machine(Protocol):
    def ask(self, do: str, *args: Any) -> Any:
        """Call a method of the agent there."""
        ...


class _Here:
    """The agent of this machine."""

    def __init__(self) -> None:
        self.agent = Agent()

    def ask(self, do: str, *args: Any) -> Any:
        return getattr(self.agent, do)(*args)


class _There:
    """The agent of the other machine, behind a pipe."""

    def __init__(self, process: subprocess.Popen[str], host: str) -> None:
        self._process = process
        self._host = host

    def start(self) -> None:
        """Send the program."""
        program = Path(peer_program.__file__).read_text(encoding="ascii")
        self._write(f"{len(program)}\n{program}")

    def ask(self, do: str, *args: Any) -> Any:
        self._write(json.dumps({"do": do, "with": args}) + "\n")
        while line := self._read():
            if line.startswith(MARK):
                try:
                    answer = msgspec.json.decode(line.removeprefix(MARK), type=_Answer)
                except msgspec.DecodeError:
                    raise PeerError(f"{self._host} sent an invalid answer.") from None
                if answer.error:
                    raise PeerError(f"{self._host}: {_printable(answer.error)}.")
                return _printable(answer.value)
        raise self._ended()

    def _write(self, text: str) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(text)
            self._process.stdin.flush()
        except OSError:
            raise self._ended() from None

    def _read(self) -> str:
        assert self._process.stdout is not None
        return self._process.stdout.readline(MAX_LINE)

    def _ended(self) -> PeerError:
        assert self._process.stderr is not None
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(5.0)
        lines = self._process.stderr.read(4096).strip().splitlines()
        reason = f": {lines[-1].rstrip('.')}" if lines else ""
        return PeerError(
            f"{self._host} cannot be examined{reason}. Check that `ssh {self._host} python3` works."
        )


@contextlib.contextmanager
def connected(host: str, ssh: str) -> Iterator[_There]:
    """Provide the agent of another machine, which ends with the block.

    Args:
        host: as ssh takes it, such as user@robot.
        ssh: command that runs a command line on the other machine, with its options; it is called
            without a shell, with `--`, the host and the command line after them.

    Raises:
        PeerError: it cannot be reached, or has no Python.
    """
    try:
        command = [*shlex.split(ssh), "--", host, PYTHON]
    except ValueError as error:
        raise PeerError(f"--ssh is not a valid command: {error}.") from None
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            errors="replace",
        )
    except OSError as error:
        raise PeerError(f"{command[0]} does not start: {error.strerror}.") from None
    giving_up = threading.Timer(LONGEST_S, process.kill)
    giving_up.daemon = True
    try:
        there = _There(process, host)
        giving_up.start()
        there.start()
        yield there
    finally:
        giving_up.cancel()
        # The program ends with its input; what does not is ended.
        for pipe in (process.stdin, process.stdout, process.stderr):
            with contextlib.suppress(OSError):
                pipe.close() if pipe else None
        try:
            process.wait(5.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


def compare(host: str, ssh: str, progress: Progress) -> TwoEnds:
    """Examine both ends.

    Args:
        host, ssh: as of `connected`.
        progress: called now and then.

    Raises:
        PeerError: the other machine cannot be examined.
    """
    progress(f"connecting to {host}", 0.0)
    with connected(host, ssh) as there:
        here = _Here()
        ours, theirs = _end(here.ask("look"), host), _end(there.ask("look"), host)
        # webviz will run where this does, whatever other nodes run with.
        ours = replace(ours, nodes=())
        progress("comparing clocks", 0.2)
        offset_s, uncertainty_s = _clocks(there)
        domain = next(iter(theirs.settings("ROS_DOMAIN_ID", "0")))
        number = int(domain) if domain.isdecimal() and int(domain) <= 232 else 0
        port = FIRST_PORT + PER_DOMAIN * number + LAST
        progress("sending packets", 0.5)
        try:
            out = _link(here, there, ours, theirs, port)
            progress("receiving packets", 0.8)
            back = _link(there, here, theirs, ours, port)
        except OSError as error:
            raise PeerError(f"UDP port {port} cannot be used: {error.strerror}.") from None
        finally:
            here.agent.close()
    return TwoEnds(
        here=ours,
        there=theirs,
        out=out,
        back=back,
        offset_s=offset_s,
        uncertainty_s=uncertainty_s,
    )


def _end(looked: Any, host: str) -> End:
    """Read what an agent has seen.

    Raises:
        PeerError: that is something else.
    """
    facts = _read_as(_Looked, looked)
    try:
        networks = [
            str(ipaddress.ip_network(f"{address}/{mask}", strict=False))
            for each in facts.interfaces
            for address, mask in each.addresses
            if not each.is_loopback
        ]
    except ValueError as error:
        raise PeerError(f"{host} sent an invalid answer: {error}.") from None
    return End(
        host=facts.host,
        python=facts.python,
        distributions=facts.distributions,
        variables=facts.variables,
        nodes=facts.nodes,
        interfaces=[
            NetworkInterface(
                each.name,
                tuple(address for address, _ in each.addresses),
                each.has_multicast,
                each.is_loopback,
                each.mtu,
            )
            for each in facts.interfaces
        ],
        networks=tuple(dict.fromkeys(networks)),
        receive_buffer=facts.receive_buffer,
    )


def _read_as(kind: type[T], value: Any) -> T:
    """Return an answer of a kind.

    Raises:
        PeerError: it is something else.
    """
    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise PeerError(f"The other machine sent an invalid answer: {error}.") from None


def _printable(value: Any) -> Any:
    """Return a value of another machine without what a terminal would take for commands."""
    match value:
        case str():
            return "".join(c if c.isprintable() else "\N{REPLACEMENT CHARACTER}" for c in value)
        case list():
            return [_printable(each) for each in value]
        case dict():
            return {_printable(key): _printable(each) for key, each in value.items()}
    return value


def _clocks(there: _Machine) -> tuple[float, float]:
    """Return the other clock's offset and its uncertainty in seconds, by the shortest round trip.

    As NTP (RFC 5905): the answer was made at some time between request and reception.
    """
    best = (float("inf"), 0.0)
    for _ in range(ROUND_TRIPS):
        sent_s, began = time.time(), time.perf_counter()
        theirs = _read_as(float, there.ask("time"))
        took = time.perf_counter() - began
        best = min(best, (took, theirs - (sent_s + took / 2)))
    return best[1], best[0] / 2


def _link(sender: _Machine, receiver: _Machine, origin: End, to: End, port: int) -> PacketLink:
    """Packets from one machine to the other, whose ends are `origin` and `to`."""
    receiver.ask("listen", port, GROUP)
    addresses = [a for each in to.interfaces if not each.is_loopback for a in each.addresses]
    tried = addresses[:MAX_ADDRESSES]
    tokens = {address: secrets.token_hex(8) for address in [GROUP, *tried]}
    for address, token in tokens.items():
        sender.ask("send", token, address, port, [64])
    arrived = _arrived(receiver, tokens.values())
    reached = [address for address in tried if tokens[address] in arrived]
    packet, via, mtu = 0, "", 0
    if reached:
        # NAT may hide by which interface the sender sent.
        sources = arrived[tokens[reached[0]]].senders
        used = [each for source in sources if (each := origin.interface(source))]
        receiving = to.interface(reached[0])
        via = used[0].name if used else ""
        mtu = min(each.mtu for each in (*used[:1], receiving)) if receiving else 0
        if used and origin.shares_network(to):
            mtu = used[0].mtu  # no router tells the sender that the receiver takes less
        token = secrets.token_hex(8)
        sizes = sorted({size for size in (*SIZES, mtu) if HEADERS + 64 <= size <= mtu})
        sender.ask("send", token, reached[0], port, [size - HEADERS for size in sizes])
        heard = _arrived(receiver, [token], mtu - HEADERS).get(token, _Heard([], [64]))
        packet = max(heard.sizes) + HEADERS
    receiver.ask("close")
    return PacketLink(
        addresses=tuple(reached),
        tried=tuple(tried),
        has_multicast=tokens[GROUP] in arrived,
        packet=packet,
        interface=via,
        mtu=mtu,
    )


def _arrived(receiver: _Machine, tokens: Iterable[str], size: int = 0) -> dict[str, _Heard]:
    """Return the packets that arrived, as soon as all did, or after a while."""
    tokens = list(tokens)
    deadline = time.monotonic() + ARRIVAL_S
    while True:
        heard = _read_as(dict[str, _Heard], receiver.ask("heard"))
        is_whole = all(t in heard and max(heard[t].sizes, default=0) >= size for t in tokens)
        if is_whole or time.monotonic() > deadline:
            return heard
        time.sleep(0.05)
