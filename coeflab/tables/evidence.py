"""What the numbers of a table show of axes and signs. Evidence is shown to a person: nothing here decides."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from coeflab.core.axes import Axes, parse_axes
from coeflab.core.texts import text_of, words
from coeflab.core.types import Array
from coeflab.law.symbols import ANGULAR, COMPONENTS, LINEAR, MOMENTS
from coeflab.tables.campaign import CUTS
from coeflab.tables.column_map import ColumnMap, unturned
from coeflab.tables.force_table import AT_REST
from coeflab.tables.half_bodies import FEWEST, Along, forces_across, judged
from coeflab.tables.mapping import Assigned
from coeflab.tables.raw_table import HALF_MODEL

TURN = "counts about the z axis of the frame: z down, r > 0 turns to starboard; z up (CFD, FLU), to port"
TURNS = {("p", True): "heels to starboard", ("p", False): "heels to port", ("q", True): "lifts the bow",
         ("q", False): "lowers the bow", ("r", True): "turns the bow to starboard", ("r", False): "turns the bow to port"}  # fmt: skip
OF_RATE = {"p": ("", "K"), "q": ("Z", "M"), "r": ("Y", "N")}  # force and moment that a rate moves first
GROUPS = (COMPONENTS[:3], COMPONENTS[3:], LINEAR, ANGULAR)
PLANES = {"pitch": (("alpha", "w", "q"), "M"), "yaw": (("beta", "v", "r"), "N")}  # motions of the body, moment
OTHER_PLANE = {"pitch": "yaw", "yaw": "pitch"}
STILL = 0.1  # of the span of Y or N: a span of Z or M that is none
SLENDER = "a slender body has"  # in what infers a sign from the force that should follow from it
NEAR = np.radians(15.0)  # of an angle of the flow: beyond it a body may stall, and nothing shows its sign
# Growth of X over an angle, of Y sin(beta) or Z sin(alpha): that of drag along the flow is 1 plus little.
AS_DRAG = (0.5, 1.5)
CLEAR = 0.8  # correlation beyond which a slope has a sign


@dataclass(frozen=True, slots=True)
class Evidence:
    """What the numbers show.

    Attributes
    ----------
    statement : str
    key, value : str
        What of campaign.toml follows from it for a slender body; empty where nothing does.
    against : str
        The rate whose sign or axis it contradicts; empty where it contradicts none.
    instead : str
        The rate of the file that turns about the axis whose force and moment vary; empty where the axis is not contradicted.
    warns : bool
        Something is wrong, or no slope follows.
    """

    statement: str
    key: str = ""
    value: str = ""
    against: str = ""
    instead: str = ""
    warns: bool = False

    @property
    def text(self) -> str:
        """The statement; with its mark where it is a warning."""
        return f"{'warning: ' * self.warns}{self.statement}"


def turn_of(meaning: ColumnMap, frame: Axes) -> str:
    """What a positive number in a column of a rate does to the body, such as turns the bow to port."""
    axis = frame.rotation[:, ANGULAR.index(meaning.name)]
    i = int(np.argmax(np.abs(axis)))
    return TURNS[ANGULAR[i], (float(axis[i]) > 0.0) != meaning.negative]


def _about_another_axis(data: Mapping[str, Array], frame: Axes) -> Iterator[Evidence]:
    """Rates about an axis whose own force and moment rest while those of the other plane vary."""
    for rate in (m for m in ANGULAR if m in data and np.any(np.nan_to_num(data[m]))):
        about = ANGULAR[int(np.argmax(np.abs(frame.rotation[:, ANGULAR.index(rate)])))]
        if about == rate == "p":
            continue  # roll moves Y and N too, and K is seldom measured
        for other in (m for m in ("q", "r") if m != about):
            found = [c for c in OF_RATE[other] if _varies(data, c, rate, frame)]
            pairs = [(own, c) for own, c in zip(OF_RATE[about], OF_RATE[other], strict=True) if own]
            if not found or any(_span(data, own, frame) > STILL * _span(data, c, frame) for own, c in pairs):
                continue
            instead = _named(other, frame)
            axes = [("forward", "aft"), ("starboard", "port"), ("down", "up")][ANGULAR.index(about)]
            points = axes[float(frame.rotation[ANGULAR.index(about), ANGULAR.index(rate)]) < 0.0]
            named = {"p": "roll", "q": "pitch", "r": "yaw"}
            yield Evidence(
                f"{rate} counts about the {'xyz'[ANGULAR.index(rate)]} axis of the frame, which points {points}: {named[about]}. "
                f"But {' and '.join(found)} of the body vary and {' and '.join(own for own, _ in pairs)} "
                f"{'does' if len(pairs) == 1 else 'do'} not: {named[other]}, which is {instead} in this frame",
                against=rate, instead=instead,
            )  # fmt: skip
            break


def _moment_of_the_other_plane(data: Mapping[str, Array], frame: Axes) -> Iterator[Evidence]:
    """A moment that varies with the motions of one plane, turned into the other plane, while this one has no moment."""
    moving = {
        plane: next((s for s in settings if _moves(data, s, frame)), "") for plane, (settings, _) in PLANES.items()
    }
    for plane, (_, own) in PLANES.items():
        other = PLANES[OTHER_PLANE[plane]][1]
        setting = moving[plane]
        values = _frd(data, other, frame)
        if not setting or moving[OTHER_PLANE[plane]] or _frd(data, own, frame) is not None or values is None:
            continue
        if not trend(values, data, _named(setting, frame)):
            continue
        now, meant = (_named(c, frame) for c in (other, own))
        about = f"{now} is about the {'xyz'['KMN'.index(now)]} axis of these axes: {other} of the body"
        yield Evidence(
            f"{setting} varies, and {plane} has no moment: {about}, which no {setting} makes. If it is the moment of "
            f"{plane}, map its column as {meant} or -{meant}; if it is {now} as the axes say, the file has no {own} of the body",
            warns=True,
        )


def _named(name: str, frame: Axes) -> str:
    """The name that a force, moment or motion of the body has in the axes of the file; an angle keeps its own."""
    group = next((g for g in GROUPS if name in g), ())
    return group[int(np.argmax(np.abs(frame.rotation[group.index(name)])))] if group else name


def _moves(data: Mapping[str, Array], setting: str, frame: Axes) -> bool:
    """Whether a motion of the body, in FRD, or an angle takes more than one value."""
    values = data.get(_named(setting, frame), np.empty(0))
    values = values[np.isfinite(values)]
    return bool(values.size and np.ptp(values) > 0.0)


def _varies(data: Mapping[str, Array], component: str, rate: str, frame: Axes) -> bool:
    values = _frd(data, component, frame)
    return values is not None and trend(values, data, rate) != 0


def _span(data: Mapping[str, Array], component: str, frame: Axes) -> float:
    values = _frd(data, component, frame)
    known = np.empty(0) if values is None else values[np.isfinite(values)]
    return float(np.ptp(known)) if known.size else 0.0


def evidence(columns: Sequence[Assigned], frame: Axes | None = None) -> tuple[Evidence, ...]:
    """What the numbers of a table show of axes and signs.

    Parameters
    ----------
    columns : sequence of Assigned
    frame : Axes, optional
        Of the file, once it is known; without it the sign of an angle stays open.
    """
    data = {one.meaning.name: one.values for one in columns if one.meaning.role not in ("word", "error")}
    out = [Evidence(why, warns=True) for one in columns if (why := unturned(one.column.name, one.meaning))]
    angles = [one.meaning.name for one in columns if one.meaning.role == "angle"]
    for angle, component, flow, side, other in (
        ("beta", "Y", "v", "starboard", "port"), ("alpha", "Z", "w", "down", "up"),
    ):  # fmt: skip
        across, turned_by = ("side", 1.0) if component == "Y" else ("lift", -1.0)
        if across in data and angle in angles and (sign := trend(turned_by * data[across], data, angle)):
            same = "the same sign" if sign * turned_by > 0 else "opposite signs"
            out.append(Evidence(f"{across} and {angle} have {same}, and {SLENDER} {component}{flow}' < 0",
                                f"axes.{angle}", f"{flow} = {'-' if sign > 0 else '+'}U sin({angle})"))  # fmt: skip
            continue
        force = _frd(data, component, frame) if frame else data.get(component)
        if angle not in angles or force is None or not (sign := trend(force, data, angle)):
            continue
        as_pointed = f"{flow} = {'-' if sign > 0 else '+'}U sin({angle})"
        turned = f"{flow} = {'+' if sign > 0 else '-'}U sin({angle})"
        have = f"{component} and {angle} have {'the same sign' if sign > 0 else 'opposite signs'}"
        if frame is None:
            axis = "yz"[component == "Z"]
            out.append(Evidence(f"{have}: {as_pointed} if {axis} points {side}, {turned} if {axis} points {other}"))
        else:
            of = "" if frame.name == "FRD" else f" to {side}"
            phrases = f"{component}{of} and {angle}" + have.removeprefix(f"{component} and {angle}")
            out.append(Evidence(f"{phrases}, and {SLENDER} {component}{flow}' < 0", f"axes.{angle}", as_pointed))
    for component, rate in (("Y", "v"), ("Z", "w"), ("K", "p"), ("M", "q"), ("N", "r")):
        if component in data and rate in data and (sign := trend(data[component], data, rate)):
            if sign < 0:
                out.append(Evidence(f"{component} and {rate} have opposite signs, as damping has in one set of axes"))
            else:
                out.append(Evidence(
                    f"{component} and {rate} have the same sign: no damping of a slender body; one of them has the "
                    f'other sign (-{rate} or -{component}), or the force contains inertia', against=rate * (rate in ANGULAR)
                ))  # fmt: skip
    crossed = list(_about_another_axis(data, frame)) if frame else []
    out += crossed
    if "r" in data and np.any(np.nan_to_num(data["r"])) and not any(e.against == "r" for e in crossed):
        up = float(frame.rotation[2][2]) if frame else 0.0
        turn = f"r > 0 turns to {'starboard' if up > 0 else 'port'}: it {TURN.partition(':')[0]}"
        out += [Evidence(turn if up else f"r {TURN}")]
    out += _moment_of_the_other_plane(data, frame) if frame else []
    out += _levers(data, {one.meaning.name: one.meaning for one in columns}, frame)
    out += _along_the_flow(columns, data, frame)
    if "drag" in data and np.any(ok := np.isfinite(data["drag"])) and np.all(data["drag"][ok] < 0.0):
        out.append(Evidence("drag is below zero in every row: that is thrust, or -drag is meant", warns=True))
    x = _frd(data, "X", frame) if frame else data.get("X")
    x = np.empty(0) if x is None else x[np.isfinite(x)]
    if frame and x.size and np.all(x > 0):
        out.append(Evidence("X is above zero in every row: in FRD that is thrust, not drag" if frame.name == "FRD"
                            else "X turned to FRD is above zero in every row: that is thrust, not drag", warns=True))  # fmt: skip
    elif not frame and x.size and (np.all(x > 0) or np.all(x < 0)):
        out.append(Evidence(f"X is {'positive' if x[0] > 0 else 'negative'} throughout: drag, if x points "
                            f"{'aft' if x[0] > 0 else 'forward'}"))  # fmt: skip
    return tuple(out)


def _along_the_flow(columns: Sequence[Assigned], data: Mapping[str, Array], frame: Axes | None) -> Iterator[Evidence]:
    """X that grows over an angle as drag along the flow does, D = -X cos(beta) - Y sin(beta) of a body turned in it."""
    axes = frame or parse_axes("FRD")
    for angle, component, wind, idle in (("beta", "Y", "side", "ZKM"), ("alpha", "Z", "lift", "YKN")):
        x, y = (frd_column(columns, c, axes) for c in ("X", component))
        if (
            x is None
            or y is None
            or angle not in data
            or x.meaning.pure != y.meaning.pure
            or x.meaning.area != y.meaning.area
        ):
            continue
        others = [
            data[s] for s in ("alpha", "beta", *LINEAR[1:], *ANGULAR, "R", "dr", "ds", "db") if s in data and s != angle
        ]
        cross, along = y.values * np.sin(data[angle]), x.values
        ok = np.isfinite(cross) & np.isfinite(along) & (np.abs(data[angle]) <= NEAR)
        ok &= np.all([np.nan_to_num(o) == 0.0 for o in others], axis=0) if others else True
        if np.unique(data[angle][ok]).size < FEWEST:
            continue
        dy, dx = cross[ok] - np.mean(cross[ok]), along[ok] - np.mean(along[ok])
        grown = float(dx @ dy) * np.sign(np.mean(cross[ok])) * np.sign(np.mean(along[ok]))
        share = grown / max(float(dy @ dy), 1e-300)
        if AS_DRAG[0] < share < AS_DRAG[1] and grown > CLEAR * np.sqrt(float(dx @ dx) * float(dy @ dy)):
            turned_by = (
                float(axes.rotation[1][1] if wind == "side" else -axes.rotation[2][2]) * (-1.0) ** y.meaning.negative
            )
            signs = (float(np.mean(x.column.values[ok])) < 0.0, turned_by < 0.0)
            maps = [
                f'--map "{c.column.name}={replace(c.meaning, name=n, negative=negative)}"'
                for c, n, negative in zip((x, y), ("drag", wind), signs, strict=True)
            ]
            still = [c.column.name for i in idle if (c := frd_column(columns, i, axes)) is not None]
            yield Evidence(
                text_of("signs.along_flow", x=x.column.name, y=y.column.name, angle=angle, share=share, maps=" ".join(maps),
                        idle=", ".join(still) or "-"),
                warns=True,
            )  # fmt: skip


def across_planes(
    columns: Sequence[Assigned], frame: Axes | None, symmetry: Sequence[str], length: float
) -> Iterator[Evidence]:
    """Forces across a plane in rows along it, as half of a body has them: a question of `HALF_MODEL`.

    Parameters
    ----------
    columns : sequence of Assigned
    frame : Axes, optional
        Of the file; FRD where nobody has said it, whose y lies as that of FLU and CFD.
    symmetry : sequence of str
        Declared; of others than port-starboard nothing is shown without.
    length : float
        m; zero where it is not known.
    """
    axes = frame or parse_axes("FRD")
    alike = {
        (c.meaning.pure, c.meaning.area, c.meaning.length if c.meaning.name in MOMENTS else None)
        for c in columns
        if c.meaning.role == "force"
    }
    if len({(pure, area) for pure, area, _ in alike}) != 1:
        return
    data = {c.meaning.name: c.values for c in columns if c.meaning.role not in ("word", "error")}
    errors = {c.meaning.name: c.values for c in columns if c.meaning.role == "error"}
    if "side" in data and _frd(data, "Y", axes) is None:
        data[_named("Y", axes)] = data["side"]
    if "lift" in data and _frd(data, "Z", axes) is None:
        data[_named("Z", axes)] = data["lift"]
    some = next(iter(data.values()), np.empty(0))
    speeds = [np.abs(data[m]) for m in ("U", *LINEAR) if m in data and m not in _primed(columns)]
    speed = float(np.nanmax(speeds, initial=0.0)) if speeds else 1.0
    for cut in (CUTS[s] for s in judged(symmetry) if s in CUTS):
        still = np.ones(some.size, dtype=bool) & ("R" not in data)
        for setting in (*cut.across, *cut.controls, {"v": "beta", "w": "alpha"}[cut.across[0]]):
            values = data.get(_named(setting, axes), np.zeros(some.size))
            scale = speed if setting in LINEAR and _named(setting, axes) not in _primed(columns) else 1.0
            still &= np.abs(np.nan_to_num(values)) <= AT_REST * max(scale, 1e-300)
        forces = {c: v for c in COMPONENTS if (v := _frd(data, c, axes)) is not None}
        theirs = {c: v for c in forces if (v := _frd(errors, c, axes)) is not None}
        rows = Along(forces, theirs, dict.fromkeys(forces, still), 0.0 if alike and next(iter(alike))[0] else length)
        found = forces_across("table", cut, rows, declared=cut.symmetry in symmetry)
        if found:
            text = words(found)
            yield Evidence(f"{text.statement}; expected: {text.rule}", HALF_MODEL)


def _primed(columns: Sequence[Assigned]) -> set[str]:
    return {c.meaning.name for c in columns if c.meaning.primed}


def _frd(data: Mapping[str, Array], component: str, frame: Axes) -> Array | None:
    group, own = next(g for g in GROUPS if component in g), _named(component, frame)
    return data[own] * float(frame.rotation[group.index(component), group.index(own)]) if own in data else None


def frd_column(columns: Sequence[Assigned], component: str, frame: Axes) -> Assigned | None:
    """The column that holds a force or velocity of the body, whatever its sign there; no standard error."""
    own = _named(component, frame)
    return next((c for c in columns if c.meaning.name == own and not c.meaning.error), None)


def astern(columns: Sequence[Assigned], frame: Axes) -> Assigned | None:
    """The column along the body's length if in FRD u is below zero in every row."""
    data = {one.meaning.name: one.values for one in columns if one.meaning.role == "velocity"}
    u = _frd(data, "u", frame)
    u = np.empty(0) if u is None else u[np.isfinite(u)]
    if not u.size or not np.all(u < 0.0):
        return None
    own = _named("u", frame)
    return next(one for one in columns if one.meaning.role == "velocity" and one.meaning.name == own)


def along_x(columns: Sequence[Assigned]) -> tuple[int, str]:
    """Where x points, 1 forward and -1 aft, 0 where nothing shows it; and what shows it, in a few words."""
    data = {one.meaning.name: one.values for one in columns if one.meaning.role in ("force", "velocity")}
    for name, forward, meaning in (("u", 1, "motion ahead"), ("X", -1, "drag")):
        known = data[name][np.isfinite(data[name])] if name in data else np.empty(0)
        if known.size and (np.all(known > 0.0) or np.all(known < 0.0)):
            positive = bool(known[0] > 0.0)
            ahead = forward if positive else -forward
            return ahead, f"{name} {'>' if positive else '<'} 0 ({meaning}), x {'forward' if ahead > 0 else 'aft'}"
    return 0, ""


def centre_of(columns: Sequence[Assigned], frame: Axes | None) -> tuple[str, str, str]:
    """Side of the centre of a circle of radius R that makes N damp, what shows it, and, without axes, how the side follows.

    Parameters
    ----------
    columns : sequence of Assigned
    frame : Axes, optional
        Of the file.
    """
    data = {one.meaning.name: one.values for one in columns if one.meaning.role != "word" and not one.meaning.error}
    if "N" not in data or "R" not in data:
        return "", "", ""
    n, straight = data["N"] * np.sign(data["R"]), np.isfinite(data["N"]) & np.isfinite(data["R"])
    for angle in ("beta", "alpha"):
        if angle in data:
            largest = float(np.nanmax(np.abs(data[angle]), initial=0.0))
            straight &= np.abs(data[angle]) <= 1e-6 * max(largest, 1e-12)
    if not np.any(straight) or abs(int(np.sum(np.sign(n[straight])))) != int(np.sum(straight)):
        return "", "", ""
    below, both = bool(n[straight][0] < 0.0), bool(np.any(data["R"] < 0.0))
    words = {True: "starboard", False: "port"}
    sign = "+R " * both
    if frame is None:
        return "", "", f"{sign}{words[below]} if z is down, else {sign}{words[not below]}"
    down = float(frame.rotation[2][2])
    if not down:
        return "", "", ""
    why = f"N in straight attitude is {'below' if below else 'above'} zero, and a slender body has Nr' < 0"
    return f"{sign}{words[below == (down > 0.0)]}", why, ""


def _levers(data: Mapping[str, Array], meanings: Mapping[str, ColumnMap], frame: Axes | None) -> list[Evidence]:
    """Where along x the forces act, which M of a left-handed triad contradicts; in FRD once the axes are known."""
    found = {}
    for moment, force, sign in (("N", "Y", 1.0), ("M", "Z", -1.0)):
        both = (_frd(data, moment, frame), _frd(data, force, frame)) if frame else (data.get(moment), data.get(force))
        if both[0] is not None and both[1] is not None:
            ok = np.isfinite(both[0]) & np.isfinite(both[1])
            m, f = both[0][ok], both[1][ok]
            if m.size >= 3 and np.any(f) and np.any(m) and abs(np.dot(m, f)) > CLEAR * np.sqrt((m @ m) * (f @ f)):
                found[moment, force] = sign * float(m @ f) / float(f @ f)
    # Of turning rows N / Y is no place of a force: Nr' / Yr' has no bound.
    turning = any(np.any(np.nan_to_num(data[m])) for m in (*ANGULAR, "R") if m in data)
    hull = "; that of a bare hull without large fins acts forward of midships"
    out = []
    for (moment, force), arm in found.items() if not turning else ():
        if frame is None:
            out.append(
                Evidence(f"{moment} / {force}: the force acts toward {'+' if arm > 0 else '-'}x of the reference point")
            )
            continue
        kinds = {meanings[c].pure for c in (moment, force) if c in meanings}
        coefficient = any(meanings[c].area for c in (moment, force) if c in meanings)
        place = (
            "" if coefficient or len(kinds) != 1 else f" (x = {arm:.2g} {'of the length' if kinds == {True} else 'm'})"
        )
        side = "forward" if arm > 0 else "aft"
        out.append(Evidence(f"{moment} / {force}: the force acts {side} of the reference point{place}{hull}"))
    if len(found) == 2 and len({np.sign(arm) for arm in found.values()}) == 2:
        out.append(Evidence("N / Y and M / Z disagree on the side: a left-handed triad, or a sign of Y, Z, M or N"))
    return out


def trend(force: Array, data: Mapping[str, Array], setting: str) -> int:
    """Sign of a force's slope over a setting while the others rest; 0 where it is not clear."""
    x = data[setting]
    ok = np.isfinite(force) & np.isfinite(x)
    if setting in ("alpha", "beta") and np.unique(x[near := ok & (np.abs(x) <= NEAR)]).size >= 3:
        ok = near
    still = ok.copy()
    for name, values in data.items():
        if name in ("alpha", "beta", "v", "w", "p", "q", "r", "dr", "ds", "db") and name != setting:
            still &= np.abs(values) <= 1e-6 * max(float(np.nanmax(np.abs(values), initial=0.0)), 1e-12)
    ok = still if np.unique(x[still]).size >= 3 else ok
    if np.unique(x[ok]).size < 3:
        return 0
    dx, df = x[ok] - np.mean(x[ok]), force[ok] - np.mean(force[ok])
    size = np.sqrt(np.dot(dx, dx) * np.dot(df, df))
    shared = float(np.dot(dx, df) / size) if size > 0.0 else 0.0
    return int(np.sign(shared)) if abs(shared) >= CLEAR else 0
