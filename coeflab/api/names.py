"""What a person may name: symbols, sources of accelerations, angles; and fresh water. Light: nothing that computes is imported."""

from __future__ import annotations

from coeflab.core.files import by_name, shipped
from coeflab.law.symbols import COMPONENTS, CONTROLS, FLOW_ANGLES, MOTIONS, primed
from coeflab.law.water import FRESH_DENSITY
from coeflab.vehicle.inertia import ACCELERATIONS

__all__ = ["ACCELERATIONS", "CONTROLS", "FLOW_ANGLES", "FRESH_DENSITY", "primed", "shipped_names", "slopes"]


class Shipped(dict[str, list[str]]):
    """Names by kind; of a kind that is not shipped the error says where names of plugins are."""

    def __missing__(self, kind: str) -> list[str]:
        raise KeyError(
            f"no {kind} among {', '.join(self)}; fits, exporters, simulators and other plugins: coeflab.plugins()"
        )


def shipped_names() -> dict[str, list[str]]:
    """Names that a reader takes without a path: of campaigns, bodies, vehicles and plans. Those of plugins has `coeflab.plugins`.

    Examples
    --------
    >>> import coeflab as cf
    >>> "suboff_roddy_2" in cf.shipped_names()["campaigns"], "remus100" in cf.shipped_names()["vehicles"]
    (True, True)
    """

    def folders(kind: str, file: str) -> list[str]:
        return sorted(place.parent.name for place in shipped(kind).glob(f"*/{file}"))

    return Shipped(
        campaigns=folders("cfd_data", "campaign.toml"), bodies=folders("geometry", "body.toml"),
        vehicles=sorted(by_name("*.parameters.json")), plans=folders("cfd_data", "plan.toml"),
    )  # fmt: skip


def slopes() -> tuple[str, ...]:
    """Derivatives of forces and moments by velocities, rates and control angles, without primes.

    Examples
    --------
    >>> slopes()[:3], len(slopes())
    (('Xu', 'Xv', 'Xw'), 54)
    """
    return tuple(f"{force}{motion}" for force in COMPONENTS for motion in (*MOTIONS, *CONTROLS))
