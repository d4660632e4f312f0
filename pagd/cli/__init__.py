"""The command line ``pagd``: every stage of the workflow, without the workflow."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence

from pagd.cli.client import ask_server

__all__ = ["main"]


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    0: done (with ``--keep-going`` also for a design that failed and left its record).
    1: the design failed; the reason is in its record and on stderr. Or a check has found something.
    2: bad input; one sentence on stderr.
    75: the machine failed, not the design; the same may succeed later.
    70: anything unforeseen, with a traceback: a fault of pagd, to be reported.
    130: interrupted.
    """
    words = sys.argv[1:] if arguments is None else list(arguments)
    code = ask_server(words)
    if code is not None:
        return code
    # Imported only here: a command that a server runs needs none of it.
    from pagd.cli.execute import execute

    return execute(words, at_terminal=sys.stderr.isatty() and os.environ.get("TERM") != "dumb")
