"""A command line in this process: parse, call the subcommand, turn what it raises into a code."""

from __future__ import annotations

import errno
import itertools
import os
import sys
import traceback
from argparse import Namespace
from collections.abc import Sequence

from pagd.bars import bars
from pagd.cli.answer import Answer, json_text, only_answer_on_stdout
from pagd.cli.options import limits_of
from pagd.cli.output import start_log
from pagd.cli.parser import make_parser
from pagd.errors import InputError, MachineError, StageFailure
from pagd.limits import under

__all__ = ["AGAIN", "FAULT", "INTERRUPTED", "execute"]

#: Exit codes.
FAILED, BAD_INPUT, FAULT, AGAIN, INTERRUPTED = 1, 2, os.EX_SOFTWARE, os.EX_TEMPFAIL, 130

# What the machine lacks, no traceback explains.
_OF_MACHINE = (errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO, errno.EMFILE, errno.ENFILE)


def execute(arguments: Sequence[str], *, at_terminal: bool = False) -> int:
    """Run a command line in this process and return its exit code, as :func:`pagd.cli.main`.

    Parameters
    ----------
    arguments
        The words behind ``pagd``.
    at_terminal
        Show bars on stderr for long work.
    """
    if not arguments:
        make_parser().print_help(sys.stderr)
        return BAD_INPUT
    try:
        try:
            # Help goes to stdout, whatever else is asked for.
            options = make_parser().parse_args(arguments)
        except InputError as error:
            as_json, answer = _asks_for_json(arguments), _complain(error, BAD_INPUT)
        else:
            as_json = vars(options).get("json", False)
            with only_answer_on_stdout(as_json):
                answer = _answered(options, at_terminal)
        if as_json:
            print(json_text(answer.document), flush=True)
    except BrokenPipeError:
        # Whoever reads has read enough (`pagd status | head`); nor can anything be told at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    return answer.code


def _asks_for_json(arguments: Sequence[str]) -> bool:
    """Whether words that could not be parsed ask for a document all the same."""
    # Behind "--" there are no options.
    return "--json" in itertools.takewhile(lambda word: word != "--", arguments)


def _answered(options: Namespace, at_terminal: bool) -> Answer:
    """Call the subcommand; what it raises is an answer too."""
    try:
        start_log(options.verbose)
        with under(limits_of(options)), bars(at_terminal):
            answer: Answer = options.handler(options)
        return answer
    except InputError as error:
        return _complain(error, BAD_INPUT)
    except StageFailure as failure:
        return _complain(f"{failure.status}: {failure.reason}", FAILED)
    except MachineError as error:
        return _complain(error, AGAIN)
    except KeyboardInterrupt:
        return _complain("interrupted", INTERRUPTED)
    except BrokenPipeError:
        raise
    except Exception as error:
        if isinstance(error, OSError) and error.errno in _OF_MACHINE:
            return _complain(f"{error}; nothing half-written is left", AGAIN)
        if isinstance(error, MemoryError):
            return _complain("the machine has no memory left for this", AGAIN)
        # Python would exit with 1, which says that the design failed.
        traceback.print_exc()
        return _complain("this is a fault of pagd; please report it", FAULT)


def _complain(what: object, code: int) -> Answer:
    print(f"pagd: {what}", file=sys.stderr)
    return Answer(code, {"error": {"message": str(what), "exit_code": code}})
