"""What a reader of somebody's model does not take over, as findings that travel with the parameter file."""

from __future__ import annotations

from collections.abc import Iterable
from xml.etree.ElementTree import Element

from coeflab.core.finding import Finding, Severity
from coeflab.core.wording import one_line

MOST, LONGEST = 40, 80  # names in a finding, letters in a name
FORCES = ("strips", "terms", "equations", "forces", "surfaces", "macros")  # on the hull


def left_out(subject: str, kind: str, names: Iterable[str]) -> tuple[Finding, ...]:
    """A finding that names what is left out; none where nothing is.

    Parameters
    ----------
    subject : str
        The file or model.
    kind : str
        Which sentence of ``coeflab/core/texts/model.toml``; of `FORCES` it warns.
    names : iterable of str
        As the file has them.
    """
    named = tuple(dict.fromkeys(one_line(n)[:LONGEST] for n in names))
    if not named:
        return ()
    more = (f"{len(named) - MOST} more",) if len(named) > MOST else ()
    severity = Severity.WARN if kind in FORCES else Severity.NOTE
    return (Finding.of("model.left_out", subject, severity, kind=kind, names=(*named[:MOST], *more)),)


# What moves nothing: letters of file or class names.
SILENT = (
    "publisher", "broadcaster", "sensor", "usercommands", "user-commands", "physics", "imu", "contact", "odometry", "camera", "dvl",
    "navsat", "particle", "jointposition", "joint-position", "gps", "altimeter", "pressure", "magnetometer", "label", "logrecord", "sceneb", "ros_interface", "salinity",
)  # fmt: skip


def other_plugins(subject: str, plugins: Iterable[Element], read: Element) -> tuple[Finding, ...]:
    """Plugins that act on a vehicle beside the one that is read: weight and buoyancy, and others."""
    forces: list[str] = []
    buoyancy: list[str] = []
    for plugin in plugins:
        both = (plugin.get("name", "") + plugin.get("filename", "")).lower()
        if plugin is read or any(s in both for s in SILENT):
            continue
        name = plugin.get("name") or plugin.get("filename") or "a plugin without a name"
        (buoyancy if "buoyancy" in both and "engine" not in both else forces).append(name)
    return (*left_out(subject, "plugins", forces), *left_out(subject, "hydrostatics", buoyancy))


def other_masses(subject: str, links: Iterable[Element], link: str) -> tuple[Finding, ...]:
    """Links with a mass of their own beside the one that is read; where a joint is fixed they are one body with it."""
    return left_out(
        subject,
        "masses",
        [e.get("name", "") for e in links if e.get("name", "") != link and e.find("inertial/mass") is not None],
    )


def unread_tags(element: Element, known: Iterable[str]) -> tuple[str, ...]:
    """Names of child elements that no law here reads, as the file has them."""
    taken = set(known)
    return tuple(f"<{child.tag}>" for child in element if isinstance(child.tag, str) and child.tag not in taken)
