"""The reduced-order analysis of a design: its cells, and if wanted the pieces between them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from pagd.actuation.follow import follow
from pagd.actuation.recorder import Recorder
from pagd.actuation.result import ActuationResult
from pagd.actuation.settings import Actuation
from pagd.design import Channel, Design
from pagd.errors import Status
from pagd.fem.assembly import Assembly, State
from pagd.fem.linear_solver import LinearSolver, linear_solver
from pagd.fem.newton import NewtonSettings
from pagd.materials import Elastomer, Sheet
from pagd.mesh.pieces import piece_between
from pagd.mesh.types import Mesh
from pagd.reduced.cell import Cell
from pagd.reduced.cell_mesh import CellMesh, cell_mesh, cuts_of
from pagd.reduced.follow_piece import FollowedPiece, follow_piece
from pagd.reduced.piece import Behind, Piece
from pagd.reduced.row import PieceShape, Row, unlike_their_neighbours
from pagd.reduced.shape import CellPath, between

FloatArray = NDArray[np.float64]

__all__ = ["ReducedRow", "SolvedCell", "SolvedPiece", "solve_row"]

# A cell moves by a hundredth of what a row does: so much smaller is its tolerance, and that of
# pieces by a tenth.
_TOLERANCE_SHARE, _TOLERANCE_SHARE_OF_PIECES = 0.01, 0.1
# Steps of a cell are chosen for a first correction of so many mm.
_WANTED_CORRECTION = 0.03


@dataclass(slots=True)
class _Keeping(Recorder):
    """A recorder that keeps the states it records."""

    kept: list[State] = field(default_factory=list)

    def record_last(self) -> None:
        count = len(self.states)
        # dataclasses with slots are made anew: super() without arguments would not find them.
        Recorder.record_last(self)
        if len(self.states) > count and self._last is not None:
            self.kept.append(self._last)


@dataclass(frozen=True, eq=False, slots=True)
class Kept:
    """The terms of a cell and the linear solver with its last factors, until that is freed."""

    assembly: Assembly
    solver: LinearSolver


@dataclass(frozen=True, eq=False, slots=True)
class SolvedCell:
    """A cell and its path.

    mesh: as its row has it, of the whole width where the row is. model: what was solved, a half
    for straight cells. result: of one cell. path: the shapes on ``mesh``. states: (p,) recorded.
    kept: what it was solved with, if that was wanted.
    """

    mesh: CellMesh
    model: Cell
    result: ActuationResult
    path: CellPath
    states: list[State]
    kept: Kept | None

    @property
    def factorisations(self) -> int:
        """Those of its path."""
        count = self.result.figures["factorisations"]
        assert isinstance(count, int)
        return count


@dataclass(frozen=True, eq=False, slots=True)
class SolvedPiece:
    """A followed piece, of the chambers ``first`` to ``last`` counted from 0.

    pressure_kPa: (p,) pressures that it reached.
    """

    first: int
    last: int
    followed: FollowedPiece

    pressure_kPa: FloatArray

    def at(self, pressure_kPa: float) -> PieceShape:
        """The shape at a pressure, between the recorded ones by a polynomial through four."""
        piece = self.followed.piece
        rows = between(self.pressure_kPa, self.followed.rows, pressure_kPa)
        place = piece.place_behind(rows) if piece.behind is not None else None
        displacement = rows[: len(piece.mesh.points)]
        return PieceShape(piece.mesh, self.first, self.last, displacement, place)


@dataclass(frozen=True, eq=False, slots=True)
class ReducedRow:
    """The solved parts of a row.

    Attributes
    ----------
    pressure_kPa
        Recorded pressures (p,) that all its parts reached, 0 first.
    cells
        By whether they are slanted.
    pieces
        In order; none where the row is made of cells alone.
    status, reason
        ``ok``, or why the last pressure was not reached.
    """

    design: Design
    pressure_kPa: FloatArray
    cells: dict[bool, SolvedCell]
    pieces: list[SolvedPiece]
    status: Status
    reason: str | None

    def displacement(self, row: Row, pressure_kPa: float) -> FloatArray:
        """Displacements (n, 3) in mm of a row's points at a pressure up to the last one."""
        shapes = {kind: cell.path.at(pressure_kPa) for kind, cell in self.cells.items()}
        return row.displacement(shapes, [piece.at(pressure_kPa) for piece in self.pieces])

    def row(self, points: FloatArray, channel: Channel) -> Row:
        """The points (n, 3) of a mesh of the design, to be asked where they are."""
        meshes = {kind: cell.mesh for kind, cell in self.cells.items()}
        return Row(self.design, meshes, points, channel.gap_floor)

    @property
    def factorisations(self) -> int:
        """Of all parts."""
        of_cells = sum(cell.factorisations for cell in self.cells.values())
        return of_cells + sum(piece.followed.factorisations for piece in self.pieces)

    def free(self) -> None:
        """Give the memory of the factors back; what asks for them computes them anew."""
        _free(self.cells)


def _free(cells: Mapping[bool, SolvedCell]) -> None:
    for cell in cells.values():
        if cell.kept is not None:
            cell.kept.solver.free()


def solve_row(
    design: Design,
    channel: Channel,
    size: float,
    material: Elastomer,
    paper: Sheet,
    actuation: Actuation | None = None,
    mesh: Mesh | None = None,
    *,
    keeps_factors: bool = False,
) -> ReducedRow:
    """Solve the cells of a design, and the pieces between them if the mesh of its row is given.

    Parameters
    ----------
    design
        A design that passes :func:`pagd.design.check`.
    channel
        The air channel.
    size
        Longest edge of a block, in mm.
    material, paper
        The elastomer and the paper.
    actuation
        Pressures, element, tolerance and contact.
    mesh
        The row in blocks of that size (of the half, if it is straight), for pieces of their own
        at its ends and where its chambers change.
    keeps_factors
        Whether the cells keep their factors, for :func:`pagd.reduced.blocked.blocked_forces`; they
        are then to be freed by :meth:`ReducedRow.free`.

    Raises
    ------
    InputError
        Where the settings cannot be used.
    """
    wanted = actuation or Actuation()
    cells: dict[bool, SolvedCell] = {}
    try:
        for kind in sorted({bool(skew) for skew in design.chamber_skews()}):
            cells[kind] = _solved_cell(
                *(design, channel, size, material, paper, wanted, kind),
                half=_is_half(kind, mesh),
                keeps=keeps_factors,
            )
        pressures, status, reason = _reached(cells)
        pieces: list[SolvedPiece] = []
        if mesh is not None:
            pieces = _solved_pieces(design, mesh, size, cells, pressures, material, paper, wanted)
            pressures, status, reason = _shortened(pieces, pressures, status, reason)
    except BaseException:
        _free(cells)
        raise
    return ReducedRow(design, pressures, cells, pieces, status, reason)


def _is_half(helical: bool, mesh: Mesh | None) -> bool:
    """Whether the half of a cell is solved: of straight ones, unless pieces are of the whole."""
    return not helical and (mesh is None or "symmetry" in mesh.surfaces)


def _solved_cell(
    design: Design,
    channel: Channel,
    size: float,
    material: Elastomer,
    paper: Sheet,
    actuation: Actuation,
    helical: bool,
    *,
    half: bool,
    keeps: bool,
) -> SolvedCell:
    """Solve a cell or its half, which is unfolded where its row is mixed."""
    mesh = cell_mesh(design, channel, size, helical=helical, half=half)
    finer = replace(actuation, tolerance_mm=_TOLERANCE_SHARE * actuation.tolerance_mm)
    model = Cell(mesh, material, paper, finer)
    recorder, assembly = _Keeping(model), model.assembly()
    solver = linear_solver(actuation.linear_solver) if keeps else None
    try:
        result = follow(model, assembly, finer, recorder, _WANTED_CORRECTION, solver=solver)
    except BaseException:
        if solver is not None:
            solver.free()
        raise
    kept = None if solver is None else Kept(assembly, solver)
    assert model.tie is not None
    # Behind a limit point the pressure falls: a row of cells is followed up to there.
    pressures = np.array([state.pressure_kPa for state in result.states])
    falls = np.flatnonzero(np.diff(pressures) <= 0)
    rising = slice(0, int(falls[0]) + 1 if len(falls) else len(pressures))
    rows, pressures = np.stack([s.displacement for s in result.states[rising]]), pressures[rising]
    states = recorder.kept[rising]
    path = CellPath(pressures, rows[:, : len(mesh.mesh.points)], rows[:, -2:], model.tie)
    if design.is_straight or not half:
        return SolvedCell(mesh, model, result, path, states, kept)
    whole = cell_mesh(design, channel, size, helical=False)
    unfolded = path.unfolded(mesh, whole)
    return SolvedCell(whole, model, result, unfolded, states, kept)


def _reached(cells: Mapping[bool, SolvedCell]) -> tuple[FloatArray, Status, str | None]:
    """The rising pressures that all cells have reached, and why they are not more."""
    last = min(
        cells.values(),
        key=lambda cell: (float(cell.path.pressure_kPa[-1]), cell.result.status is Status.ok),
    )
    known = last.path.pressure_kPa
    others = [cell.path.pressure_kPa for cell in cells.values()]
    shared = [p for p in known if all(np.isclose(other, p).any() for other in others)]
    status, reason = last.result.status, last.result.reason
    if len(known) < len(last.result.states):
        status = Status.not_converged
        reason = f"At {known[-1]:.4g} kPa a chamber passes a limit point of the pressure."
    if reason and len(cells) > 1:
        kind = "slanted" if last is cells.get(True) else "straight"
        reason = f"Of the {kind} cells: {reason}"
    return np.array(shared), status, reason


def _solved_pieces(
    design: Design,
    mesh: Mesh,
    size: float,
    cells: Mapping[bool, SolvedCell],
    pressures: FloatArray,
    material: Elastomer,
    paper: Sheet,
    actuation: Actuation,
) -> list[SolvedPiece]:
    settings = NewtonSettings(
        tolerance=_TOLERANCE_SHARE_OF_PIECES * actuation.tolerance_mm,
        iterations=14,
        growth=2.0,
        contraction=0.55,
        reuses=8,
    )
    kinds = [bool(skew) for skew in design.chamber_skews()]
    starts, skews = design.chamber_starts(), design.chamber_skews()
    front, back = cuts_of(design, size)
    found: list[SolvedPiece] = []
    for first, last in unlike_their_neighbours(design):
        is_last = last == design.N - 1
        low = starts[first] + front if first else -np.inf
        high = np.inf if is_last else starts[last] + back
        part = piece_between(mesh, low, high, skews[first], skews[last]).mesh
        part = replace(part, points=part.points - [starts[first], 0.0, 0.0])
        before = cells[kinds[first]] if first else None
        behind = None if is_last else cells[kinds[last]]
        piece = Piece(
            part,
            before.mesh if before else None,
            Behind(behind.mesh, starts[last + 1] - starts[first]) if behind else None,
            material,
            paper,
            actuation,
        )
        followed = follow_piece(
            piece,
            before.path if before else None,
            behind.path if behind else None,
            [float(p) for p in pressures[1:]],
            settings,
            actuation.linear_solver,
        )
        found.append(SolvedPiece(first, last, followed, pressures[: len(followed.rows)]))
    return found


def _shortened(
    pieces: list[SolvedPiece], pressures: FloatArray, status: Status, reason: str | None
) -> tuple[FloatArray, Status, str | None]:
    """The pressures that all pieces have reached as well."""
    shortest = min(pieces, key=lambda piece: len(piece.followed.rows))
    count = len(shortest.followed.rows)
    if count == len(pressures):
        return pressures, status, reason
    where = f"chambers {shortest.first + 1} to {shortest.last + 1}"
    path = shortest.followed.path
    status = Status.buckled if path.is_unstable else Status.not_converged
    failure = path.failure or path.stopped
    return pressures[:count], status, f"Of {where}, beyond {pressures[count - 1]:g} kPa: {failure}."
