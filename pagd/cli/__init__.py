"""The command line ``pagd``: every stage of the workflow, without the workflow."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence

from pagd.cli.output import start_log
from pagd.cli.parser import make_parser
from pagd.errors import InputError, StageFailure

__all__ = ["main"]

#: Exit codes.
FAILED, BAD_INPUT, FAULT, INTERRUPTED = 1, 2, os.EX_SOFTWARE, 130


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line and return its exit code.

    0: done (with ``--keep-going`` also for a design that failed and left its record).
    1: the design failed; the reason is in its record and on stderr.
    2: bad input; one sentence on stderr.
    70: anything unforeseen, with a traceback: a fault of pagd, to be reported.
    130: interrupted.
    """
    options = make_parser().parse_args(arguments)
    start_log(options.verbose)
    try:
        code: int = options.handler(options)
        return code
    except InputError as error:
        return _complain(error, BAD_INPUT)
    except StageFailure as failure:
        return _complain(f"{failure.status}: {failure.reason}", FAILED)
    except KeyboardInterrupt:
        return _complain("interrupted", INTERRUPTED)
    except Exception:
        # Python would exit with 1, which says that the design failed.
        traceback.print_exc()
        return _complain("this is a fault of pagd; please report it", FAULT)


def _complain(what: object, code: int) -> int:
    print(f"pagd: {what}", file=sys.stderr)
    return code
