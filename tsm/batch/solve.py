"""`solve_batch`: many structures of one topology."""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from tsm.batch.march import March
from tsm.batch.result import BatchResult, from_record, from_results
from tsm.batch.topology import check_alike, covered
from tsm.elements.properties import Array
from tsm.model import Model
from tsm.settings import Settings
from tsm.solve import checked, solve
from tsm.structure import Structure


def solve_batch(
    structures: Sequence[Structure], load_parameters: Array, settings: Settings | None = None
) -> BatchResult:
    """Equilibrium of many structures of one topology at the same load parameters.

    Newton's method runs for all of them in the same array operations, each structure with its own load step, contacts, events and
    status; `solve` finds the same for each alone, to round-off where the tolerance is sharp. Structures that loads or moving
    supports drive, that touch exact elements or the paper's, that have curved or tapered beams, or no contacts are solved one after
    the other.

    Parameters
    ----------
    structures : sequence of Structure
        Alike in everything but coordinates, turns and lengths of elements, sections, loads, pin paths, and sides, offsets and `keep` of
        contacts.
    load_parameters, settings
        As for `solve`.

    Returns
    -------
    BatchResult
        One status per structure; never raises for a structure that stops.

    Raises
    ------
    ValueError
        If the structures are not alike, or as for `solve`, naming the structure.

    Examples
    --------
    >>> import numpy as np, tsm
    >>> def cantilever(EI):
    ...     section = tsm.Section(EA=3e4 * EI, GA=9.6e3 * EI, EI=EI)
    ...     return tsm.Structure(
    ...         beams=(tsm.Beam(name="cantilever", start=(0, 0), end=(1, 0), section=section, elements=10),),
    ...         supports=(tsm.Support(beam="cantilever", end="start"),),
    ...         pins=(tsm.Pin(name="pin", path=((1, 0), (0, 0.6366))),),
    ...         contacts=(tsm.ContactPair(node="pin", beam="cantilever", side="right"),),
    ...     )
    >>> batch = tsm.solve_batch([cantilever(EI) for EI in (1.0, 2.0)], np.linspace(0.02, 1, 50))
    >>> batch.force["pin->cantilever"][:, -1].round(4).tolist()
    [8.1728, 16.3456]
    >>> batch[1].status.name
    'COMPLETED'
    """
    structures = tuple(structures)
    check_alike(structures)
    targets, settings = checked(load_parameters, structures[0].stages), settings or Settings()
    begin = time.perf_counter()
    with _named(0):
        model = Model(structures[0])
    if covered(structures, model):
        record = March(structures, model, targets, settings).run()
        return from_record(structures, model, targets, record, time.perf_counter() - begin)
    results = []
    for n, structure in enumerate(structures):
        with _named(n):
            results.append(solve(structure, targets, settings, throw=False))
    return from_results(results, targets, time.perf_counter() - begin)


@contextmanager
def _named(n: int) -> Iterator[None]:
    """Say which structure is not right."""
    try:
        yield
    except ValueError as error:
        raise ValueError(f"structures[{n}]: {error}") from error
