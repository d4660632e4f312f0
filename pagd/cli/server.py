"""A process that has everything loaded and forks a worker for every command it is asked for.

The interpreter, the imports and the compiled kernels of a stage take longer than many a stage. A
workflow of thousands of them pays once: it calls :func:`start`, and the ``pagd`` commands that it
runs find the server by an environment variable (:mod:`pagd.cli.client`). Each command has a
process of its own, forked from the server, with the folder, the environment and the standard
streams of the command: what it does, or what it dies of, reaches no other.

The server ends, and its workers with it, when the process that has started it is gone.
"""

from __future__ import annotations

import os
import selectors
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
import traceback
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from pagd.cli.client import SERVER

__all__ = ["start"]

_FAULT: Final = os.EX_SOFTWARE

#: A client has sent its request by then, and an interrupted worker has tidied up, in seconds.
_PATIENCE_S: Final = 10.0

_THREADS: Final = (
    "OMP_NUM_THREADS",
    "MKL_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "NUMBA_NUM_THREADS",
)

#: Held, since the server ends when its standard input is closed.
_started: list[subprocess.Popen[bytes]] = []


def start() -> None:
    """Start a server for the commands that this process runs, unless there can be none.

    It loads nothing before the first command asks for it, and ends with this process.
    """
    folder = tempfile.mkdtemp(prefix="pagd-")
    path = str(Path(folder, "socket"))
    with socket.socket(socket.AF_UNIX) as listener:
        try:
            # Bound here, so that no command can come too early.
            listener.bind(path)
            listener.listen(socket.SOMAXCONN)
        except OSError:  # the path is too long, or there are no such sockets
            shutil.rmtree(folder)
            return
        process = subprocess.Popen(
            [sys.executable, "-P", "-m", "pagd.cli.server", str(listener.fileno()), path],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            pass_fds=[listener.fileno()],
            env=os.environ | dict.fromkeys(_THREADS, "1"),
            start_new_session=True,
        )
    os.environ[SERVER] = path
    _started.append(process)


@dataclass(frozen=True, slots=True)
class _Request:
    """What :mod:`pagd.cli.client` sends."""

    words: list[str]
    folder: str
    environment: dict[str, str]
    streams: list[int]


class _Server:
    """Serves until ``lifeline``, which nobody writes to, is closed at the other end."""

    def __init__(self, listener: socket.socket, lifeline: int) -> None:
        self._listener, self._lifeline = listener, lifeline
        self._workers: dict[int, socket.socket] = {}
        self._kernels: int | None = None  # not loaded
        # A worker that ends interrupts the wait for whatever comes next.
        self._ended, self._wakeup = socket.socketpair()
        self._ended.setblocking(False)
        self._wakeup.setblocking(False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        signal.set_wakeup_fd(self._wakeup.fileno())
        self._selector = selectors.DefaultSelector()
        for source in (listener, lifeline, self._ended):
            self._selector.register(source, selectors.EVENT_READ)

    def serve(self) -> None:
        """Take requests until the end of the process that has started this one."""
        while True:
            for key, _ in self._selector.select():
                if key.fileobj == self._lifeline:
                    return self._end()
                if key.fileobj is self._ended:
                    self._collect()
                elif key.fileobj is self._listener:
                    self._accept()
                elif self._workers.get(key.data) is key.fileobj:
                    self._leave(key.data)

    def _accept(self) -> None:
        connection, _ = self._listener.accept()
        try:
            request = _receive(connection)
        except (OSError, ValueError, IndexError):
            connection.close()
            return
        self._load()
        # An interrupt must not find the forked process before it is ready for one.
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        process = os.fork()
        if process == 0:
            code = _FAULT
            try:
                code = self._work(connection, request)
            finally:  # nothing may run on as a second server
                os._exit(code)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
        for stream in request.streams:
            os.close(stream)
        self._workers[process] = connection
        self._selector.register(connection, selectors.EVENT_READ, process)

    def _load(self) -> None:
        from pagd.cli.preload import preload
        from pagd.fem.compiled import load_kernels

        if self._kernels is None:
            self._kernels = preload()
        elif self._kernels == 0:  # the first workers may have compiled them by now
            self._kernels = load_kernels()

    def _work(self, connection: socket.socket, request: _Request) -> int:
        """Run a command in the forked process; return its exit code."""
        try:
            signal.set_wakeup_fd(-1)
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            signal.signal(signal.SIGINT, signal.default_int_handler)
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
            # Only the server holds on to the clients: with it, they lose the connection.
            self._selector.close()
            own = (self._listener, self._ended, self._wakeup)
            for other in (connection, *self._workers.values(), *own):
                other.close()
            _take_place(request)
            return _run(request.words)
        except BaseException:
            traceback.print_exc()
            return _FAULT

    def _collect(self) -> None:
        """Tell the clients of the workers that have ended."""
        with suppress(BlockingIOError):
            while self._ended.recv(4096):
                pass
        while self._workers:
            process, status = os.waitpid(-1, os.WNOHANG)
            if process == 0:
                return
            connection = self._workers.pop(process)
            code = os.waitstatus_to_exitcode(status)
            with suppress(KeyError):  # a client that has left is not watched any more
                self._selector.unregister(connection)
            with suppress(OSError):
                connection.sendall(b"%d\n" % code)
            connection.close()

    def _leave(self, process: int) -> None:
        """Interrupt the worker of a client that is gone."""
        self._selector.unregister(self._workers[process])
        _interrupt(process)

    def _end(self) -> None:
        """Interrupt all workers; kill those that do not end in time."""
        for process in self._workers:
            _interrupt(process)
        limit = time.monotonic() + _PATIENCE_S
        while self._workers and time.monotonic() < limit:
            time.sleep(0.05)
            self._collect()
        for process in self._workers:
            with suppress(ProcessLookupError):
                os.killpg(process, signal.SIGKILL)  # its group bears its number


def _receive(connection: socket.socket) -> _Request:
    connection.settimeout(_PATIENCE_S)
    size, streams, _, _ = socket.recv_fds(connection, 16, 3)
    with connection.makefile("rb") as file:
        count, *parts = file.read(int(size)).split(b"\0")
    connection.settimeout(None)
    texts = [os.fsdecode(part) for part in parts]
    words = int(count)
    pairs = (text.partition("=") for text in texts[words + 1 :])
    environment = {name: value for name, _, value in pairs}
    return _Request(texts[:words], texts[words], environment, streams)


def _take_place(request: _Request) -> None:
    """Put this process in the place of the one that asks."""
    os.setsid()
    for number, stream in enumerate(request.streams):
        os.dup2(stream, number)
        os.close(stream)
    os.chdir(request.folder)
    os.environ.clear()
    # Numba reads the number of its threads again whenever it compiles, and must find the same.
    os.environ.update(request.environment | dict.fromkeys(_THREADS, "1"))


def _run(arguments: list[str]) -> int:
    from pagd.cli.execute import execute

    try:
        return execute(arguments)
    except SystemExit as end:  # the parser's, after it has told what is wrong
        return end.code if isinstance(end.code, int) else _FAULT
    finally:
        sys.stdout.flush()
        sys.stderr.flush()


def _interrupt(process: int) -> None:
    """Let a worker end what it has started, and itself."""
    with suppress(ProcessLookupError):
        os.kill(process, signal.SIGINT)


def _main(descriptor: str, path: str) -> None:
    listener = socket.socket(fileno=int(descriptor))
    try:
        _Server(listener, sys.stdin.fileno()).serve()
    finally:
        shutil.rmtree(Path(path).parent, ignore_errors=True)


if __name__ == "__main__":
    _main(*sys.argv[1:])
