"""The parser's ways with people: subcommands under headings, bad usage told in one sentence."""

from __future__ import annotations

import argparse
import difflib
from collections.abc import Mapping, Sequence
from typing import Any

from pagd.errors import InputError

__all__ = ["Parser"]


class Parser(argparse.ArgumentParser):
    """A parser that raises ``InputError`` where argparse would print its usage and exit.

    Attributes
    ----------
    headings
        Heading to the names of the subcommands under it, for the help; none: no headings.
    """

    headings: Mapping[str, Sequence[str]] = {}

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        # An option that is cut short would mean another one as soon as there is a new one.
        super().__init__(*args, **{"allow_abbrev": False, **kwargs})

    def error(self, message: str) -> Any:
        """Refuse a command line, with the nearest name where a subcommand is misspelt."""
        for action in self._subcommands():
            for name in _refused(message):
                raise InputError(f"{name!r} is no {action.metavar}{self._hint(name, action)}.")
        raise InputError(f"{message} (see {self.prog} --help).")

    def parse_args(self, args: Any = None, namespace: Any = None) -> Any:
        """Parse a command line; options that are unknown are told with the nearest known one."""
        options, unknown = self.parse_known_args(args, namespace)
        if unknown:
            # The subcommand's own parser, which knows what it is called and what it takes.
            vars(options).get("parser", self).refuse(unknown)
        return options

    def refuse(self, unknown: Sequence[str]) -> None:
        """Refuse words that the parser does not know, the first of them by name."""
        word = unknown[0].partition("=")[0]
        if word in self._option_string_actions:
            raise InputError(f"{word} must come after the subcommand: {self.prog} … {word}.")
        near = difflib.get_close_matches(word, self._option_string_actions, n=1)
        hint = f"did you mean {near[0]}?" if near else f"see {self.prog} --help"
        kind = "an option" if word.startswith("-") else "an argument"
        raise InputError(f"{word} is not {kind} of {self.prog} ({hint}).")

    def format_help(self) -> str:
        """Return the help, with the subcommands under their headings."""
        if not self.headings:
            return super().format_help()
        formatter = self._get_formatter()
        formatter.add_usage(self.usage, self._actions, self._mutually_exclusive_groups)
        formatter.add_text(self.description)
        listed = {one.dest: one for action in self._subcommands() for one in _entries(action)}
        for heading, names in self.headings.items():
            formatter.start_section(heading)
            formatter.add_arguments([listed[name] for name in names])
            formatter.end_section()
        formatter.start_section("options")
        formatter.add_arguments(self._get_optional_actions())
        formatter.end_section()
        formatter.add_text(self.epilog)
        return formatter.format_help()

    def _subcommands(self) -> list[Any]:
        return [one for one in self._actions if isinstance(one, argparse._SubParsersAction)]

    def _hint(self, name: str, action: Any) -> str:
        near = difflib.get_close_matches(name, action.choices, n=1)
        return f" (did you mean {near[0]}?)" if near else f" (see {self.prog} --help)"


def _entries(action: Any) -> list[argparse.Action]:
    """The entries of subcommands in a help text, as argparse makes them."""
    found: list[argparse.Action] = action._choices_actions
    return found


def _refused(message: str) -> list[str]:
    """The subcommand that argparse refuses, of its message; none if it refuses something else."""
    _, colon, rest = message.partition(": invalid choice: ")
    if not colon or not message.startswith(("argument command", "argument action")):
        return []
    return [rest.partition(" (choose from")[0].strip("'")]
