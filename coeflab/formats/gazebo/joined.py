"""How an SDF or URDF model hangs together: names twice, joints and plugins of links that are not there, loops, axes without direction."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from pathlib import Path
from xml.etree.ElementTree import Element

from coeflab.core.finding import Finding, Severity
from coeflab.core.table import Check, as_check
from coeflab.core.text.xml import numbers
from coeflab.core.wording import one_line
from coeflab.formats.gazebo.assembly import MODEL, MOST_JOINTS, MOVING, joint_end, pose_base
from coeflab.formats.left_out import MOST

HOLDERS = {"joint_name": "joint", "control_joint_name": "joint", "link_name": "link"}
FRAMES = ("link", "joint", "frame", "model")
AXIAL = tuple(k for k in MOVING if k not in ("ball", "floating", "gearbox"))


def structure_checks(root: Element, hydrodynamics: Element, path: Path) -> list[Check]:
    """Findings about names, joints, frames and plugins; of names alone where other files are included.

    Parameters
    ----------
    root : Element
        As `coeflab.formats.gazebo.law.as_sdf` leaves it.
    hydrodynamics : Element
        Its plugin, whose link is judged elsewhere.
    path : Path

    Raises
    ------
    InputError
        An axis that is no number.
    """
    found = list(_twice(root))
    if root.find(".//include") is None:
        found += [*_ends(root), *_holders(root, hydrodynamics), *_bases(root)]
    found += [*_axes(root, path)]
    own = [m for m in root.iter("model") if any(e is hydrodynamics for e in m.iter("plugin"))]
    if any((m.findtext("static") or "").strip().lower() in ("true", "1") for m in own):
        found.append(Finding.of("model.static", "<static>", Severity.WARN))
    return [as_check("gazebo", f) for f in found]


def _named(root: Element, tags: Iterable[str]) -> set[str]:
    return {e.get("name", "") for tag in tags for e in root.iter(tag)}


def _joints(root: Element) -> list[Element]:
    return [j for j in root.iter("joint") if j.get("name") is not None and j.find("child") is not None][:MOST_JOINTS]


def _twice(root: Element) -> Iterator[Finding]:
    for parent in root.iter():
        for tag in ("link", "joint", "model"):
            counted = Counter(e.get("name", "") for e in parent if e.tag == tag)
            for name, count in counted.items():
                if count > 1:
                    yield Finding.of("model.same_name", _short(tag, name), Severity.FAIL, statistic=float(count), count=count, what=tag)  # fmt: skip


def _ends(root: Element) -> Iterator[Finding]:
    """Joints of links that are not there, and those that lead from a link back to itself."""
    known = _named(root, FRAMES) | {"world", MODEL}
    models = {id(j): i for i, model in enumerate(root.iter("model")) for j in model.findall("joint")}
    trees: dict[int, dict[str, str]] = {}
    for joint in _joints(root):
        parent, child = joint_end(joint, "parent"), joint_end(joint, "child")
        if missing := tuple(one_line(n) for n in (parent, child) if n not in known):
            yield Finding.of("model.no_end", _short("joint", joint.get("name", "")), Severity.FAIL, names=missing)
        if any("::" in (joint.findtext(end) or "") for end in ("parent", "child")):
            continue  # a link of another model may have the same name
        above = trees.setdefault(models.get(id(joint), -1), {})
        at, seen = parent, {child}
        while at in above and at not in seen:
            seen.add(at)
            at = above[at]
        if at in seen:
            yield Finding.of("model.loop", _short("joint", joint.get("name", "")), Severity.FAIL, name=one_line(child))
        else:
            above.setdefault(child, parent)


def _holders(root: Element, hydrodynamics: Element) -> Iterator[Finding]:
    """Plugins of a joint or link that is not there: the simulator leaves them out."""
    known = {what: _named(root, (what,)) for what in HOLDERS.values()}
    for plugin in root.iter("plugin"):
        for tag, what in HOLDERS.items():
            for e in plugin.findall(tag) if plugin is not hydrodynamics else ():
                name = (e.text or "").strip()
                if name and name.rpartition("::")[2] not in known[what]:
                    subject = one_line(plugin.get("name") or plugin.get("filename") or "plugin").rpartition("::")[2]
                    yield Finding.of("model.no_holder", subject[:100], Severity.FAIL, name=one_line(name), what=what, tag=tag)  # fmt: skip


def _bases(root: Element) -> Iterator[Finding]:
    """Poses relative to a frame that is not there, or to each other."""
    known = {*_named(root, FRAMES), "world", MODEL, ""}
    for scope in root.iter():
        bases = {e.get("name", ""): pose_base(e.find("pose")) for e in scope if e.tag in FRAMES}
        for name, base in bases.items():
            at, seen = base, {name}
            while at in bases and at not in seen and at and len(seen) < MOST_JOINTS:
                seen.add(at)
                at = bases[at]
            if base.rpartition("::")[2] not in known or (at and at in seen):
                yield Finding.of("model.no_base", _short("pose", name), Severity.FAIL, name=one_line(base))


def _axes(root: Element, path: Path) -> Iterator[Finding]:
    names = []
    for joint in _joints(root):
        axis = joint.find("axis")
        text = None if axis is None else axis.get("xyz") or axis.findtext("xyz")
        if joint.get("type") in AXIAL and text and not any(numbers(text, (3,), "axis xyz", path)):
            names.append(one_line(joint.get("name", "")))
    if names:
        yield Finding.of("model.no_axis", "<axis>", Severity.FAIL, names=tuple(names)[:MOST])


def _short(what: str, name: str) -> str:
    return f"{what} {one_line(name)}"[:100]
