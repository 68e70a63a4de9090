"""What thrusters and fins of a gz-sim model let go wrong: units of their coefficients, the water they are in, limits, a plugin written twice."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.text.xml import numbers
from coeflab.core.wording import one_line
from coeflab.formats.gazebo.actuators import is_system
from coeflab.formats.gazebo.lift_drag import DEFAULTS
from coeflab.vehicle.imported_numbers import water

# Tags of a plugin, between which values they are in any vehicle in water. A Wageningen screw has K_T of 0.1 to 0.6 at rest.
USUAL = {
    "thruster": {"thrust_coefficient": (2e-4, 0.05), "propeller_diameter": (5e-3, 5.0)},
    "lift-drag": {"cla": (0.3, 20.0), "alpha_stall": (0.02, 3.2)},
}
MEDIUM = {"thruster": ("fluid_density", None), "lift-drag": ("air_density", DEFAULTS["air_density"])}
SAME = {"thruster": ("joint_name",), "lift-drag": ("link_name", "control_joint_name", "forward", "upward", "cp")}
ENDS = {"thruster": ("min_thrust_cmd", "max_thrust_cmd")}
HOLDER = {"thruster": "joint_name", "lift-drag": "link_name"}


def actuator_checks(root: Element, path: Path) -> list[Check]:
    """Findings about every Thruster and LiftDrag of a model.

    Raises
    ------
    InputError
        A tag that is no number.
    """
    out: list[Check] = []
    for kind, holder in HOLDER.items():
        plugins = [p for p in root.iter("plugin") if is_system(p, kind) and not is_system(p, "advanced")]
        for plugin in plugins:
            subject = f"{kind} of {one_line(plugin.findtext(holder) or 'nothing')}"[:100]
            out += [as_check("gazebo", f) for f in _usual(plugin, kind, subject, path)]
            tag, default = MEDIUM[kind]
            density = _value(plugin, tag, path) if plugin.find(tag) is not None else default
            found = None if density is None else water("gazebo", density, f"<{tag}> of {subject}")
            out += [] if found is None or found.severity is Severity.PASS else [found]
        out += [as_check("gazebo", f) for f in _twice(plugins, kind)]
    return out


def _usual(plugin: Element, kind: str, subject: str, path: Path) -> Iterator[Finding]:
    for tag, (least, most) in USUAL[kind].items():
        if plugin.find(tag) is not None and (value := abs(_value(plugin, tag, path))) and not least <= value <= most:
            yield Finding.of(
                "model.coefficient", subject, Severity.WARN, statistic=value, threshold=most, least=least, what=tag
            )
    ends = [_value(plugin, t, path) for t in ENDS.get(kind, ()) if plugin.find(t) is not None]
    if len(ends) == 2 and ends[0] > ends[1]:
        yield Finding.of("model.limits", subject, Severity.WARN, low=ends[0], high=ends[1])


def _twice(plugins: list[Element], kind: str) -> Iterator[Finding]:
    keys = Counter(tuple(" ".join((p.findtext(t) or "").split()) for t in SAME[kind]) for p in plugins)
    for key, count in keys.items():
        if count > 1:
            yield Finding.of(
                "model.twice", f"{kind} of {one_line(key[0])}"[:100], Severity.FAIL, statistic=float(count), count=count
            )


def _value(parent: Element, tag: str, path: Path) -> float:
    text = (parent.findtext(tag) or "").strip()
    return float(text) if text.lstrip("+-").lower() in ("inf", "infinity") else numbers(text, (1,), tag, path)[0]
