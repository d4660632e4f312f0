"""Hand a command to the server of :mod:`pagd.cli.server`, where a workflow has started one.

Light on purpose: this is all that ``pagd`` imports when a server does the work.
"""

from __future__ import annotations

import os
import socket
import sys

__all__ = ["SERVED", "SERVER", "ask_server"]

#: Environment variable with the path of the server's socket.
SERVER = "PAGD_SERVER"

#: Subcommands that a server takes: the stages of one design that draw no pictures.
SERVED = ("geometry", "repair", "mesh", "solve", "metrics", "export")

_STANDARD_STREAMS = (0, 1, 2)
_FAULT, _INTERRUPTED = os.EX_SOFTWARE, 130


def ask_server(arguments: list[str]) -> int | None:
    """Return the exit code of a command that the server has run.

    None where this process has to run it: there is no server, it does not answer, or the command
    is none for it. A command may have one thread there, since the libraries of the server have
    read the number of their threads already.
    """
    path = os.environ.get(SERVER)
    if not path or not arguments or arguments[0] not in SERVED:
        return None
    if os.environ.get("OMP_NUM_THREADS") != "1":
        return None
    with socket.socket(socket.AF_UNIX) as connection:
        try:
            connection.connect(path)
            _send(connection, arguments)
        except OSError:
            return None
        return _wait(connection)


def _send(connection: socket.socket, arguments: list[str]) -> None:
    """Send the standard streams; then the words, the folder and the environment of the command.

    The length of the text first, then its parts between null bytes, which none of them can hold:
    the number of words, the words, the folder, the variables. (To import a format takes longer.)
    """
    words = [os.fsencode(word) for word in arguments]
    variables = [name + b"=" + value for name, value in os.environb.items()]
    folder = os.getcwdb()  # noqa: PTH109 (to import pathlib takes longer)
    text = b"\0".join([b"%d" % len(words), *words, folder, *variables])
    socket.send_fds(connection, [b"%16d" % len(text)], _STANDARD_STREAMS)
    connection.sendall(text)


def _wait(connection: socket.socket) -> int:
    """Return the exit code; the server ends the command if this process is gone before."""
    try:
        answer = connection.makefile("rb").readline()
    except KeyboardInterrupt:
        return _INTERRUPTED
    except OSError:
        answer = b""
    if not answer.endswith(b"\n"):
        return _complain("the server has gone; the same command goes without it", _FAULT)
    code = int(answer)
    if code >= 0:
        return code
    import signal

    return _complain(f"the process was ended by {signal.Signals(-code).name}", 128 - code)


def _complain(what: str, code: int) -> int:
    print(f"pagd: {what}", file=sys.stderr)
    return code
