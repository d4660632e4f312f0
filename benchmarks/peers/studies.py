"""The studies with CalculiX: all runs that they need."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from pagd.errors import InputError
from pagd.record import read_record
from peers import calculix, ours
from peers.bodies import Body, made
from peers.comparison import Comparison, EqualError, compared, equal_error, median_of
from peers.converged import FEWEST_MESHES, Converged, extrapolated, read_converged, write_converged
from peers.kept import Keeper
from peers.solved import Load, Solved

__all__ = ["EqualErrorRow", "SameMeshRow", "Study"]


@dataclass(frozen=True, slots=True)
class SameMeshRow:
    """Both programs on one mesh."""

    body: Body
    ours: Solved
    theirs: Solved
    comparison: Comparison


@dataclass(frozen=True, slots=True)
class EqualErrorRow:
    """pagd on its mesh, and the other program on finer and finer ones."""

    body: Body
    ours: Solved
    error: float
    pressure_kPa: float
    finer: Sequence[tuple[Body, Solved, float | None]]
    result: EqualError


@dataclass(frozen=True, slots=True, kw_only=True)
class Study:
    """What is compared, and the folder of all results.

    Attributes
    ----------
    folder
        For converged tips, and in ``peers`` meshes and kept results.
    bodies
        What pagd solves.
    load
        Pressure, threads, time limit.
    element
        Of pagd; the default of the configuration unless given.
    repeats
        Runs of pagd, the median of which counts.
    fresh
        Whether to run again what is kept.
    """

    folder: Path
    bodies: Sequence[Body]
    load: Load
    element: str | None = None
    repeats: int = 3
    fresh: bool = False

    def keeper(self) -> Keeper:
        """Return what keeps the results."""
        return Keeper(self.folder / "peers", self.fresh)

    def mesh(self, body: Body) -> Path:
        """Return the folder of a mesh."""
        return made(body, self.folder / "peers" / "meshes")

    def exact(self) -> dict[str, Converged]:
        """Return the converged tips that are known, by design."""
        return read_converged(self.folder)

    def ours(self, body: Body, repeats: int | None = None) -> Solved:
        """Solve a body by pagd."""
        mesh = self.mesh(body)
        return median_of(
            [
                ours.solve(body, mesh, self.load, self.keeper(), self.element, repeat)
                for repeat in range(repeats or self.repeats)
            ]
        )

    def theirs(self, body: Body) -> Solved:
        """Solve a body by CalculiX."""
        return calculix.solve(body, self.mesh(body), self.load, self.keeper())

    def converge(self, order: float) -> dict[str, Converged]:
        """Extrapolate the tip of each design over its bodies, and write the file of tips.

        Raises
        ------
        InputError
            If the bodies of a design are too few, or of several meshers.
        """
        designs = dict.fromkeys(body.design for body in self.bodies)
        if len({body.mesher for body in self.bodies}) > 1:
            raise InputError("--mesher: must be one to extrapolate over meshes, not several.")
        if len(self.bodies) < FEWEST_MESHES * len(designs):
            raise InputError(
                f"--sizes, --blocks and --halvings must give {FEWEST_MESHES} meshes at least to "
                "extrapolate over."
            )
        tips = {}
        for design in designs:
            # Coarse to fine: what is missing in the end are the meshes that take longest.
            bodies = [body for body in self.bodies if body.design == design]
            bodies.sort(key=lambda body: (body.halvings, -body.size_mm))
            runs = [self.ours(body, repeats=1) for body in bodies]
            sizes = [body.size_mm / 2**body.halvings for body in bodies]
            tips[design] = extrapolated(design, sizes, runs, order)
            write_converged(self.folder, tips)
        return tips

    def same_mesh(self) -> Iterator[SameMeshRow]:
        """Run both programs on each body."""
        exact = self.exact()
        for body in self.bodies:
            us, them = self.ours(body), self.theirs(body)
            yield SameMeshRow(body, us, them, compared(us, them, exact.get(body.design)))

    def equal_error(self, finer_mm: Sequence[float]) -> Iterator[EqualErrorRow]:
        """Run pagd on each body, and CalculiX on finer and finer meshes until it is as good.

        Parameters
        ----------
        finer_mm
            Sizes of meshes, of which those that are no coarser than a body's are tried.

        Raises
        ------
        InputError
            If the converged tip of a design is not known.
        """
        for body in self.bodies:
            exact, us = self._exact_of(body), self.ours(body)
            known = {p for p, _ in us.tips} & set(exact.pressure_kPa)
            pressure = max(known, default=0.0)
            error = exact.error(us, pressure)
            if error is None:
                raise InputError(f"{body.design}: {_how_to_converge(us.last_recorded())}")
            finer = list(self._finer(body, exact, error, pressure, finer_mm))
            tried = [
                (run.seconds_to(pressure), found)
                for _, run, found in finer
                if found is not None or run.status == "time_limit"
            ]
            result = equal_error(us.seconds_to(pressure), error, tried)
            yield EqualErrorRow(body, us, error, pressure, finer, result)

    def _finer(
        self,
        body: Body,
        exact: Converged,
        error: float,
        pressure: float,
        finer_mm: Sequence[float],
    ) -> Iterator[tuple[Body, Solved, float | None]]:
        """Finer and finer meshes, to the first that is as good or takes too long."""
        last = 0
        for size in sorted({body.size_mm, *(s for s in finer_mm if s < body.size_mm)})[::-1]:
            finer = Body(body.design, body.mesher, size, body.half)
            tets = read_record(self.mesh(finer)).figures["tets"]
            if tets == last:
                # Blocks no smaller than the walls are thick give one and the same mesh.
                continue
            last = tets
            run = self.theirs(finer)
            found = exact.error(run, pressure)
            yield finer, run, found
            if run.status == "time_limit" or (found is not None and found <= error):
                return

    def _exact_of(self, body: Body) -> Converged:
        exact = self.exact().get(body.design)
        if exact is None:
            raise InputError(f"{body.design}: {_how_to_converge(self.load.maximum_kPa)}")
        return exact


def _how_to_converge(pressure_kPa: float) -> str:
    return (
        f"the mesh-converged tip at {pressure_kPa:g} kPa is not known; "
        f"`python benchmarks/peers.py converged --maximum-pressure {pressure_kPa:g}` computes it."
    )
