"""What bounds an iteration: how near its factorisation is to what the processor can do at most.

    python benchmarks/bounds.py [--designs bending twisting mixed] [--pressure 30]
        [--repeats 5] [--page docs/performance.md]

One thread. Beside the times of one tangent, factorisation and solution stand a product of dense
matrices, the fastest that the processor multiplies and adds, and a copy of memory, the fastest that
it reads and writes. Give nothing else to do to the machine meanwhile.
"""

from __future__ import annotations

import argparse
import sys

from performance.bounds import machine_rates, measured, text_of
from performance.memory import memory_of
from performance.options import add_examples, command_of, must_be_positive
from performance.origin import origin_lines
from performance.page import must_have_section, publish
from threadpoolctl import threadpool_limits

from pagd.actuation.threads import use_threads
from pagd.errors import InputError

_SECTION = "bounds"


def main() -> None:
    """Measure, and print the section or write it to the page."""
    parser = _parser()
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
        must_be_positive({"pressure": options.pressure, "repeats": options.repeats})
        # What is loaded by now, and then MKL, which is not.
        with threadpool_limits(1):
            use_threads(1)
            rates, found = machine_rates(options.repeats), {}
            for name in options.designs:
                print(name, file=sys.stderr, flush=True)
                found[name] = measured(name, options.pressure, options.repeats)
            memory = {name: memory_of(name) for name in options.designs}
        usual = vars(_parser().parse_args([]))
        first = origin_lines(command_of("benchmarks/bounds.py", vars(options), usual))
        publish(
            options.page, _SECTION, f"{first}\n\n{text_of(rates, found, memory, options.pressure)}"
        )
    except InputError as error:
        parser.error(str(error))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    add_examples(parser)
    parser.add_argument("--pressure", type=float, default=30.0, help="in kPa")
    parser.add_argument("--repeats", type=int, default=5, help="the fastest of so many counts")
    return parser


if __name__ == "__main__":
    main()
