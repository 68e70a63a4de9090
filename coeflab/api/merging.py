"""`merge`: numbers of a vehicle replaced, one by one, by those of another file, of a campaign, or of a person."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from coeflab.api.parameters import plausibility
from coeflab.core.table import Check
from coeflab.motion.manoeuvre import Simulation
from coeflab.motion.uncertainty.uncertainty import Carried
from coeflab.study.estimated_vehicle import given_by, replaced
from coeflab.study.run import run
from coeflab.vehicle.merge import Merged
from coeflab.vehicle.own_numbers import OwnNumber, as_file, own_numbers
from coeflab.vehicle.parameter_file import ParameterFile

__all__ = ["Merge", "merge", "own_numbers"]


@dataclass(frozen=True, slots=True)
class Merge:
    """A merge, and what the estimates that are left do to the first manoeuvres.

    Attributes
    ----------
    merged : Merged
        ``parameters``, what was replaced, what is still an estimate.
    moves : tuple of Simulation
    carried : tuple of Carried
    source : str
        Name of what replaced estimates.
    checks : tuple of Check
        What ``coeflab params check`` finds in the merged file.
    """

    merged: Merged
    moves: tuple[Simulation, ...]
    carried: tuple[Carried, ...]
    source: str
    checks: tuple[Check, ...]

    def files(self) -> dict[str, bytes]:
        """The merged parameter file, its tables and its report, by name; nothing is written."""
        from coeflab.report.rendered import replaced_files

        return replaced_files(self.merged, self.moves, self.carried)


def merge(
    first: ParameterFile,
    other: str | Sequence[OwnNumber],
    name: str = "",
    progress: Callable[[str], None] = lambda _: None,
) -> Merge:
    """Merge a file, a campaign or numbers into a parameter file; what the other does not give stays.

    Parameters
    ----------
    first : ParameterFile
    other : str or sequence of OwnNumber
        A parameter file, a campaign, which is fitted about the first one's reference point, or numbers one by one.
    name : str
        Of the merged file; that of the first with ``_merged`` unless given.
    progress : callable, optional
        Takes what is being done, in words.

    Raises
    ------
    InputError, ScalingMismatchError
        As of `coeflab.study.estimated_vehicle.replaced`.

    Examples
    --------
    >>> import coeflab as cf
    >>> done = merge(cf.read_vehicle("huuv").file, own_numbers(["Yv'=-0.03 +- 0.003"]))
    >>> [r.symbol for r in done.merged.replaced]
    ["Yv'"]
    """
    by_hand = not isinstance(other, str)
    second, own = given_by(other, first, run) if isinstance(other, str) else (as_file(first, other), first.scaling)
    progress("merging, and moving what came out")
    result, moves, carried = replaced(first, second, name or f"{first.name}_merged", own, alone=by_hand)
    # a tow bears the name of its body, as the estimates do
    source = second.name if by_hand or second.name != first.name else str(other)
    return Merge(result, moves, carried, source, tuple(plausibility(result.parameters)))
