"""Do to a small sweep what happens to large ones, and count what is left after a restart.

    python benchmarks/drill.py [--only NAME] [--designs 6] [--page docs/sweeps.md]

After every fault and a restart, each design must have one record of its last stage that says the
same as after a run without any fault, no design that was done before must be computed again, and no
file must be damaged or half-written. --page writes the section of the drills.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from drills.counting import Count, count, text_of
from drills.faults import FAULTS, Drill, Needs
from drills.project import Sweep
from performance.origin import origin_lines
from performance.page import must_have_section, publish

from pagd.errors import InputError

_SECTION = "drills"


def main() -> int:
    """Run the drills; 1 if any leaves what it must not."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n\n")[0])
    names = [drill.name for drill in FAULTS]
    parser.add_argument("--only", metavar="NAME", choices=names, action="append")
    parser.add_argument("--designs", type=int, default=6)
    parser.add_argument("--page", type=Path)
    options = parser.parse_args()
    try:
        must_have_section(options.page, _SECTION)
    except InputError as error:
        parser.error(str(error))
    wanted = [drill for drill in FAULTS if not options.only or drill.name in options.only]
    counts = _counts(wanted, options.designs)
    command = "python benchmarks/drill.py" + (f" --page {options.page}" if options.page else "")
    publish(options.page, _SECTION, f"{origin_lines(command)}\n\n{text_of(counts)}")
    return 0 if all(each.is_sound for each in counts) else 1


def _counts(drills: list[Drill], designs: int) -> list[Count]:
    with tempfile.TemporaryDirectory(prefix="pagd-drill-", ignore_cleanup_errors=True) as name:
        folder = Path(name)
        calm = Sweep(folder / "calm", designs)
        assert calm.run() == 0, (calm.folder / "output.txt").read_text(encoding="utf-8")
        wanted, found = calm.results(), []
        for number, drill in enumerate(drills):
            begun = time.monotonic()
            try:
                found.append(count(drill, *drill.inflict(folder / str(number), designs), wanted))
            except (Needs, AssertionError) as why:
                found.append(
                    Count(drill=drill, designs=designs, why=str(why), needs=isinstance(why, Needs))
                )
            print(f"{found[-1].line()} ({time.monotonic() - begun:.0f} s)", flush=True)
        return found


if __name__ == "__main__":
    sys.exit(main())
