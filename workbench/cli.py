"""Defines the command `workbench`, which starts the server and opens the browser."""

from __future__ import annotations

import argparse
import html
import http.client
import signal
import socket
import sys
import tempfile
import threading
import time
import webbrowser
import zlib
from collections.abc import Sequence
from contextlib import closing, suppress
from functools import partial
from pathlib import Path

from actr3d.output import all_written, report_unwritten, standard_output
from workbench.auth import LOOPBACK, REFUSAL, Gate, Token
from workbench.built_manual import build_manual
from workbench.retention import MAX_MEGABYTES, MAX_RECORDINGS, RetentionLimits
from workbench.shipped import models_folder
from workbench.worker.memory import MODEL_MEMORY
from workbench.worker.spawn import spawn

READ_TIME = 20.0
"""How long a browser may take to start and to read the file that redirects it here [s]."""
PORTS = range(20_000, 32_000)
"""The default ports of models folders: below those that operating systems give to other connections."""
PROBE_TIME = 2.0
"""How long a server at the usual port of a folder may take to show that it is a workbench [s]."""


def _count(text: str) -> int:
    if not text.isdecimal():
        raise argparse.ArgumentTypeError(f"must be a whole number >= 0 (got {text})")
    return int(text)


def _port(text: str) -> int:
    if _count(text) >= 65536:
        raise argparse.ArgumentTypeError(f"must be < 65536 (got {text})")
    return int(text)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="workbench",
        description="Runs models in the browser: step, go back, see buffers and productions, edit and run again.",
    )
    parser.add_argument("models", nargs="?", type=Path, metavar="MODELS_FOLDER", help="the models (default: ./models, or a folder at home)")
    parser.add_argument("--host", default="127.0.0.1", help="where to listen; anything but loopback lets others reach it")
    parser.add_argument("--port", type=_port, help="the port (default: the same at each start for a models folder; 0: any free one)")
    parser.add_argument("--name", action="append", default=[], metavar="NAME", help="another name by which browsers may call this server")
    parser.add_argument("--no-browser", action="store_true", help="do not open the browser")
    parser.add_argument(
        "--memory",
        type=_count,
        default=MODEL_MEMORY,
        metavar="MB",
        help=f"how much memory a model may take (default {MODEL_MEMORY}; 0: no limit)",
    )
    parser.add_argument(
        "--recordings",
        type=_count,
        default=MAX_RECORDINGS,
        metavar="N",
        help=f"how many recordings are kept (default {MAX_RECORDINGS}; 0: no limit)",
    )
    parser.add_argument(
        "--recordings-size",
        type=_count,
        default=MAX_MEGABYTES,
        metavar="MB",
        help=f"maximum size of all recordings (default {MAX_MEGABYTES}; 0: no limit); the oldest unnamed ones are deleted at the start",
    )
    return parser


def listen(host: str, port: int) -> socket.socket:
    """Returns a listening socket.

    Raises:
        OSError: If the address is not available.
    """
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio sends at once (TCP_NODELAY) only on sockets that name their protocol; else each answer waits 40 ms for the one before.
    listening = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind((host.strip("[]"), port))
        listening.listen(128)
    except OSError:
        listening.close()
        raise
    return listening


def port_of(folder: Path) -> int:
    """Returns the default port of a models folder: browsers keep sizes and unsaved texts for each port, and links contain it."""
    return PORTS[zlib.crc32(bytes(folder.resolve())) % len(PORTS)]


def listen_for(folder: Path, host: str, port: int | None) -> socket.socket:
    """Returns a listening socket at a port; without one, at the port of the models folder, or at any free one if that is taken.

    Raises:
        OSError: If the address is not available.
    """
    if port is not None:
        return listen(host, port)
    try:
        return listen(host, port_of(folder))
    except OSError:
        return listen(host, 0)


def other_port_warning(folder: Path, host: str, port: int) -> str:
    """Returns why a workbench has this port instead of the usual one of its models folder, and what this means for its user."""
    usual = port_of(folder)
    owner, advice = "another program", "End that program and start again"
    with suppress(OSError, http.client.HTTPException):
        asked = http.client.HTTPConnection(host.strip("[]"), usual, timeout=PROBE_TIME)
        with closing(asked):
            asked.request("GET", "/", headers={"Host": f"localhost:{usual}"})
            if asked.getresponse().read(len(REFUSAL)).decode("utf-8", "replace") == REFUSAL:
                owner, advice = "another workbench, most likely with the same folder", "Use that one, or end it and start again"
    return (
        f"port {usual}, the usual one of this folder, is taken by {owner}.\n"
        f"This workbench has port {port} instead: its page has settings of its own, without what the browser keeps for the\n"
        f"usual port (sizes of panels, unsaved texts), and links to the usual port do not lead here. {advice}."
    )


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command until it is interrupted and returns its exit code."""
    options = _parser().parse_args(arguments)
    interrupted = threading.Event()

    def interrupt(*_: object) -> None:
        interrupted.set()
        raise KeyboardInterrupt

    signal.signal(signal.SIGINT, interrupt)
    try:
        folder = models_folder(options.models, Path.cwd(), Path.home())
        listening = listen_for(folder, options.host, options.port)
    except OSError as error:
        print(f"error: {_reason(error, options)}", file=sys.stderr)
        return 1
    host, port = options.host if ":" not in options.host else f"[{options.host.strip('[]')}]", listening.getsockname()[1]
    if options.port is None and port != port_of(folder):
        print(f"warning: {other_port_warning(folder, options.host, port)}", file=sys.stderr)
    local = host in LOOPBACK
    if not local:
        print(f"warning: others can reach {host}; anyone with the address below can run programs as you", file=sys.stderr)
    names: list[str] = [*options.name, host]
    gate = Gate(token=Token(), port=port, hosts=LOOPBACK | {name.lower() for name in names})
    fork_server = spawn()  # it loads at the same time as the server
    try:
        from workbench.app import make_app
        from workbench.server import serve

        limits = RetentionLimits(number=options.recordings, megabytes=options.recordings_size)
        address = f"http://{host}:{port}/?token={gate.token.reveal()}"
        app = make_app(folder, gate, memory=options.memory, limits=limits, fork_server=fork_server)
        if interrupted.is_set():  # the import of a library may have swallowed the exception
            raise KeyboardInterrupt
        if unwritten := _announce(folder, address):
            return report_unwritten(unwritten)
        serve(app, listening, partial(_open, address, not options.no_browser))
    except KeyboardInterrupt:
        return 130
    return 0


def _reason(error: OSError, options: argparse.Namespace) -> str:
    """Returns why the server cannot start: which folder or address is not available."""
    reason = error.strerror or str(error)
    if error.filename is None:
        port = "" if options.port is None else f", port {options.port}"
        return f"cannot listen at {options.host}{port}: {reason}"
    where = Path(error.filename)
    return f"the models folder '{where}' cannot be used: {'it is a file' if where.is_file() else reason}"


def _announce(folder: Path, address: str) -> OSError | None:
    """Prints the address as the last line; returns why it cannot be written, if so."""
    with standard_output(apart=False) as out:
        with suppress(OSError):  # returned
            print(f"models: {folder}\n{address}", file=out)
        return all_written(out, None)


def _open(address: str, browse: bool) -> None:
    """Opens the address in the browser, and builds the manual for its user if there is none."""
    if browse:
        build_manual()
        threading.Thread(target=_browse, args=(address,), daemon=True).start()


def _browse(address: str) -> None:
    """Opens the address in the browser through a file that only its user can read, because lists of processes show command lines."""
    with tempfile.TemporaryDirectory(prefix="workbench-") as folder:
        page = Path(folder) / "open.html"
        page.write_text(f'<meta http-equiv="refresh" content="0; url={html.escape(address)}">', encoding="utf-8")
        webbrowser.open(page.as_uri())
        time.sleep(READ_TIME)


if __name__ == "__main__":
    sys.exit(main())
