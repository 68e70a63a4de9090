"""`shaped`: the study of a shape and a mass: estimates, first motions, checks, exports, and what a campaign replaces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from coeflab.api.merging import Merge, merge
from coeflab.bodies.body import Body
from coeflab.core.types import brief
from coeflab.formats.export import exports_of, placed, refuse_unknown
from coeflab.study.checking import checked
from coeflab.study.estimated_vehicle import NOTHING, asked, campaigns_named, completed_by_hand, from_shape
from coeflab.study.study import Plan, Study
from coeflab.vehicle.from_shape import Stated

__all__ = ["MERGED", "Shaped", "Study", "asked", "completed_by_hand", "shaped"]
MERGED = "merged"  # the folder of what a campaign replaces


@brief
@dataclass(frozen=True, slots=True)
class Shaped:
    """A vehicle of a shape.

    Attributes
    ----------
    study : Study
        Of the estimates, checked; with exports of the merged file where there is one.
    merge : Merge or None
        What a campaign replaces.
    """

    study: Study
    merge: Merge | None = None

    def files(self) -> dict[str, bytes]:
        """Parameter files, report and exports, by place; those of `merge` are its own. Nothing is written."""
        from coeflab.report.rendered import rendered

        if self.merge is None:
            return rendered(self.study)
        exported = {f"{MERGED}/{place}": content for place, content in placed(self.study.exports).items()}
        return rendered(replace(self.study, exports=(), refused=())) | exported


def shaped(
    plan: Plan, body: Body, stated: Stated = NOTHING, *, campaign: str = "", wall: str = "", distances: Sequence[float] = (),
    progress: Callable[[str], None] = lambda _: None,
) -> Shaped:  # fmt: skip
    """Estimate a vehicle from its shape and mass, move it, check it, and export it as its plan says.

    Parameters
    ----------
    plan : Plan
        Without tables: name, exports, manoeuvres, conditions, scaling; `asked` makes one of what a person types.
    body : Body
        With a shape.
    stated : Stated
        What is known of its mass beside the body's file.
    campaign : str
        Whose fits replace estimates, or several with commas between; then the merged file is exported, and the estimates are not.
    wall, distances
        As of `coeflab.study.estimated_vehicle.from_shape`.
    progress : callable, optional
        Takes what is being done, in words.

    Raises
    ------
    InputError, PluginError
        As `coeflab.vehicle`; no exporter of a target's name.

    Examples
    --------
    >>> import coeflab as cf
    >>> body = cf.read_body("remus100")
    >>> plan, stated = asked(body, speed="1.5 m/s", method="ellipsoid")
    >>> found = shaped(plan, body, stated)
    >>> found.study.parameter_files["remus100"].coefficient("Yv'").value < 0
    True
    """
    if campaign:
        campaigns_named(campaign)  # before minutes of added mass
    refuse_unknown(plan.exports)
    study = checked(
        from_shape(replace(plan, exports=()) if campaign else plan, body, stated, progress, wall, distances), progress
    )
    if not campaign:
        return Shaped(study)
    progress(f"fitting {campaign}")
    merged = merge(next(iter(study.parameter_files.values())), campaign, progress=progress)
    shape = next(iter(study.hulls.values())).body.shape
    seen = {} if shape is None else {merged.merged.parameters.name: shape}
    exports, refused = exports_of(plan.exports, [merged.merged.parameters], progress, seen)
    return Shaped(replace(study, exports=exports, refused=refused), merged)
