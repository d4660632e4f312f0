"""A command line in this process: parse, call the subcommand, turn what it raises into a code."""

from __future__ import annotations

import os
import sys
import traceback
from collections.abc import Sequence

from pagd.cli.output import start_log
from pagd.cli.parser import make_parser
from pagd.errors import InputError, StageFailure

__all__ = ["FAULT", "INTERRUPTED", "execute"]

#: Exit codes.
FAILED, BAD_INPUT, FAULT, INTERRUPTED = 1, 2, os.EX_SOFTWARE, 130


def execute(arguments: Sequence[str]) -> int:
    """Run a command line in this process and return its exit code, as :func:`pagd.cli.main`."""
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
