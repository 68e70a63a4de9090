"""What every column of a table probably is, with the others beside it: of several the first, and what only company tells."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence, Set
from dataclasses import replace

import numpy as np

from coeflab.core.axes import Axes
from coeflab.core.types import Array
from coeflab.core.units import fits, quantity
from coeflab.law.symbols import LINEAR, MOMENTS
from coeflab.tables.column_map import (
    FORCES,
    SETTINGS,
    read_column_map,
)
from coeflab.tables.column_names import UNKNOWN, named_as
from coeflab.tables.proposals import AREA, LENGTH_OF, OPEN, PURE, Proposal, Reason, allowed, proposed
from coeflab.tables.raw_table import RawColumn, RawTable
from coeflab.tables.vocabulary import folded, vocabulary
from coeflab.tables.words.axes import BODY_AXES

GIVEN_AS_COEFFICIENTS = "lift, drag and moments are there as coefficients already"
TURNED_WIND = "lift and drag turned by alpha, in every row"
PROPELLER = "a coefficient of the propeller, by its name beside J"
OF_PROPELLER = frozenset({"ct", "cp", "cq", "kt", "kq", "10kq"})
SIDEWAYS = frozenset({"beta", "v", "r", "R", "dr", "Y", "side"})  # without which a Cn need not be a yaw moment
FEW_STRANGE = 2  # columns without a known name or unit that are asked one by one
MOST_ASKED = 6  # of which more ask a person too much
SAME = 0.1
TURNED_APART = 0.02
ROUNDED = 1e-4  # of the largest of lift and drag
STILL, OF_ROUNDING = "zeros throughout", "zeros but for rounding"
GOES_ALONG = 0.9  # correlation with a setting: a coupled rudder, not a second measurement
VARIED = frozenset(SETTINGS) - {"speed"}  # which alone make no sweep
FROUDE = 1.5
REYNOLDS = frozenset({"re", "reynolds", "reynoldsnumber"})
MACH = 1.2  # of what may still be water or a slow wind tunnel


def proposals(
    raw: RawTable, known: Mapping[str, object] | None = None, frame: Axes | None = None
) -> tuple[Proposal, ...]:
    """What every column of a table may be; of several that may be the same, or name the rows, only the first keeps it.

    Parameters
    ----------
    raw : RawTable
    known : mapping, optional
        What a person says of coefficients and of units that are not stated; see `proposed`.
    frame : Axes, optional
        Of the file, where they are known.
    """
    stated = {key: None if s.contradicted else s.value for key, s in raw.stated.items()} | dict(known or {})
    offered = any(s.offered for key, s in raw.stated.items() if key.startswith("coefficients.")) or bool(known)
    out: list[Proposal] = []
    taken: dict[str, str] = {}
    turned = _turned_wind(raw.columns)
    pure = {folded(c.name) for c in raw.columns if c.unit in PURE} & {*vocabulary().coefficients, *vocabulary().several}
    names = {named_as(c.name).partition(" ")[0] for c in raw.columns} | {folded(c.name) for c in raw.columns} & {
        *REYNOLDS,
        "side",
    }
    of_rounding = _zeros_by_rounding(raw.columns)
    for column in (replace(c, values=np.zeros(len(c.values))) if c.name in of_rounding else c for c in raw.columns):
        if column.name in turned:
            one = Proposal("ignore", TURNED_WIND, note=TURNED_WIND)
        else:
            one = by_stated_area(_of_company(proposed(column, stated), column, pure, names, frame, stated), known or {})
        one = replace(one, certain=False) if offered and "coefficient" in one.text else one
        one = _along_the_body(one, column, raw.stated[BODY_AXES].place) if BODY_AXES in raw.stated else one
        if (
            one.reason is Reason.UNKNOWN
            and not one.text
            and not allowed(column.unit)
            and column is raw.columns[0]
            and _is_index(column)
        ):
            one = Proposal("point", "it counts the rows")
        given = one.meaning
        if given is not None and given.name not in ("label", "ignore"):
            if given.name == "point" and (given.plain in taken or _repeats(column)):
                one = Proposal("label", f"{one.why}, but rows share it" if _repeats(column) else one.why, one.certain)
            elif given.plain in taken:
                first = next(i for i, c in enumerate(raw.columns) if c.name == taken[given.plain])
                again = f"{given.plain} is {{}} already"
                unsized = (
                    out[first].text.endswith(f"[{OPEN}]") and "coefficient" in one.text
                )  # a force without unit beside its coefficient
                if (one.whole and not out[first].whole) or unsized:
                    out[first] = Proposal("ignore", again.format(column.name))
                    taken[given.plain] = column.name
                else:
                    settled = _is_settled(out[first], raw.columns[first], one, column)
                    one = Proposal("ignore" * settled, again.format(taken[given.plain]), reason=Reason.REPEATED)
            else:
                taken[given.plain] = column.name
        out.append(_still(one, column, column.name in of_rounding))
    out = _beside_the_flow(out, taken)
    if len(doubles := [o for o in out if not o.text and o.reason is Reason.REPEATED]) > FEW_STRANGE:
        out = [replace(o, text="ignore", note=o.why) if o in doubles else o for o in out]
    out = without_strangers(raw, out)
    for i, column in enumerate(raw.columns):
        # V is the speed beside what says where the water comes from, and over a resistance; alone it may be a sway velocity in capitals.
        over = {"drag"} - {
            read_column_map(n).name for c in raw.columns if (n := named_as(c.name)) in ("Y", "N", "side")
        }
        companion = ({"alpha", "beta", "R"} | over) & set(taken) and not {"U", "v"} & set(taken)
        if companion and column.name.strip() == "V" and out[i].reason is Reason.UNKNOWN and fits(column.unit, "speed"):
            out[i] = Proposal(f"U [{column.unit}]", "its unit, beside an angle or a radius")
            taken["U"] = column.name
        if folded(column.name) in vocabulary().lists["ship"] and taken.get("U", column.name) != column.name:
            out[i] = Proposal("ignore", f"U is {taken['U']} already")
        if column.name.strip() == "Q" and {"rps", "thrust"} & set(taken) and fits(column.unit, "moment"):
            out[i] = Proposal("ignore", "the torque of the propeller, by its name beside its rate or thrust")
        if {"r", "R"} <= set(taken) and column.name == taken["R"]:
            out[i] = Proposal("ignore", f"r is {taken['r']} already, U over it")
    return tuple(_without_a_doubled_flow(raw, _without_lone_errors(out)))


def _beside_the_flow(out: list[Proposal], taken: Mapping[str, str]) -> list[Proposal]:
    """X and Z beside lift and drag are these turned, and left; a drag beside a force of the body alone has its other reading."""
    if {"lift", "drag"} <= taken.keys():
        body = [
            one.meaning is not None and one.meaning.name in ("X", "Z") and not one.meaning.error and not one.certain
            for one in out
        ]
        return [
            Proposal("ignore", GIVEN_AS_COEFFICIENTS, note=GIVEN_AS_COEFFICIENTS) if o else one
            for one, o in zip(out, body, strict=True)
        ]
    if "drag" in taken and "side" not in taken and (force := next((c for c in "YZ" if c in taken), "")):
        return [_or_body_force(one, taken[force], force) for one in out]
    return out


def _is_settled(before: Proposal, first: RawColumn, one: Proposal, column: RawColumn) -> bool:
    """Whether of two columns of one meaning the first is it: it is whole, a force beside its coefficient, the same numbers, or the
    later one is an allowance that does not vary.
    """
    kinds = {"coefficient" in o.text for o in (one, before)}
    varies, later = (bool(np.ptp(np.nan_to_num(c.values)) > 0.0) for c in (first, column))
    return (
        (before.whole and not one.whole)
        or len(kinds) == 2
        or (varies and not later)
        or _agree(column.values, first.values, ROUNDED)
    )


def _still(one: Proposal, column: RawColumn, rounded: bool) -> Proposal:
    """A column of zeros that is asked is of no use to a fit."""
    zeros = not one.text and len(column.values) > 0 and not column.is_text and not np.any(column.values)
    return Proposal("ignore", f"{one.why}; {OF_ROUNDING if rounded else STILL}", reason=one.reason) if zeros else one


_SPREAD = frozenset({"std", "min", "max", "rms", "ci"})
_UNNAMED = re.compile(r"column \d+")


def _is_index(column: RawColumn) -> bool:
    """Whether a column without a name, or called so, counts the rows from 0 or 1, again from there where tables were joined."""
    first = column.values[0] if len(column.values) > 1 else np.nan
    steps = np.diff(column.values)
    unnamed = column.name == "column 1" or folded(column.name) in vocabulary().lists["index"]
    return unnamed and first in (0.0, 1.0) and bool(np.all((steps == 1.0) | (column.values[1:] == first)))


def _without_lone_errors(out: Sequence[Proposal]) -> list[Proposal]:
    """A standard error whose force is left out goes with it."""
    valued = {m.name for one in out if (m := one.meaning) is not None and not m.error}
    lone = [(m := one.meaning) is not None and m.error and m.name not in valued for one in out]
    return [
        Proposal("ignore", f"no column {one.meaning.name}") if o and one.meaning else one
        for one, o in zip(out, lone, strict=True)
    ]


def _without_a_doubled_flow(raw: RawTable, out: Sequence[Proposal]) -> Iterator[Proposal]:
    """Of angles of the flow beside components of the speed those that are zeros throughout say nothing."""
    roles = [one.meaning for one in out]
    still = [not np.any(np.nan_to_num(c.values)) for c in raw.columns]
    both = [
        ("angle" if m.role == "angle" else "speed")
        if m and not m.error and (m.role == "angle" or m.name in LINEAR)
        else ""
        for m in roles
    ]
    varied = {kind for kind, zero in zip(both, still, strict=True) if kind and not zero}
    for one, kind, zero in zip(out, both, still, strict=True):
        yield (Proposal("ignore", f"{one.why}; {STILL}") if kind and zero and varied and kind not in varied else one)


def _zeros_by_rounding(columns: Sequence[RawColumn]) -> frozenset[str]:
    """Names of the coefficients across the plane of a table without motion sideways that are nothing beside its forces: what rounding
    leaves of a zero. Without a CL beside it a Cl is lift.
    """
    own = {c.name: named_as(c.name).partition(" ")[0] for c in columns}
    moving = [
        c for c in columns if own[c.name] in ("beta", "v", "r", "R", "dr") and np.ptp(np.nan_to_num(c.values)) > 0.0
    ]
    pure = {
        c.name: float(np.max(np.abs(np.nan_to_num(c.values)), initial=0.0))
        for c in columns
        if c.unit in PURE and not c.is_text
    }
    largest = max((size for name, size in pure.items() if own[name] in ("lift", "drag")), default=0.0)
    across = {name for name, what in own.items() if what in ("Y", "N", "K", "side")}
    across |= {name for name in own if name.strip() == "CS" or (name.strip() == "Cl" and "CL" in own)}
    return frozenset() if moving else frozenset(n for n in across & {*pure} if 0.0 < pure[n] < ROUNDED * largest)


def _turned_wind(columns: Sequence[RawColumn]) -> frozenset[str]:
    """Names of the pure numbers that are lift and drag along the body, normal or axial, of either sign: no forces of their own."""
    own = {named_as(c.name): c for c in reversed(columns) if not c.is_text and not c.means}
    if not {"alpha", "lift", "drag"} <= {*own} or own["lift"].unit not in PURE:
        return frozenset()
    alpha, lift, drag = (own[name].values for name in ("alpha", "lift", "drag"))
    if not np.any(np.nan_to_num(alpha)):
        return frozenset()
    angle = alpha if own["alpha"].unit == "rad" else np.radians(alpha)
    normal, axial = lift * np.cos(angle) + drag * np.sin(angle), drag * np.cos(angle) - lift * np.sin(angle)
    used = {own[name].name for name in ("alpha", "lift", "drag")}
    others = [c for c in columns if c.unit in PURE and not c.is_text and c.name not in used]
    return frozenset(c.name for c in others for force in (normal, axial) if _agree(np.abs(c.values), np.abs(force)))


def _agree(one: Array, other: Array, within: float = TURNED_APART) -> bool:
    """Whether two columns agree in every row where both are known, within a share of the largest."""
    both = np.isfinite(one) & np.isfinite(other)
    largest = float(np.max(one[both], initial=0.0))
    return bool(both.sum() > FEW_STRANGE) and float(np.max(np.abs(one - other)[both])) < within * largest


def _of_company(
    one: Proposal, column: RawColumn, pure: Set[str], names: Set[str], frame: Axes | None, stated: Mapping[str, object]
) -> Proposal:
    """A column that the coefficients beside it make another thing than its name: M a Mach number, N a count, CN a normal force.

    Parameters
    ----------
    one : Proposal
    column : RawColumn
    pure : set of str
        Folded names of the coefficients of the table.
    names : set of str
        What all columns are by their names.
    frame : Axes or None
        Of the file, where they are known.
    stated : mapping
        As for `proposed`.
    """
    known, bare = column.values[np.isfinite(column.values)], folded(column.name)
    if (
        "J" in names
        and bare in OF_PROPELLER
        and column.unit in PURE
        and not {"alpha", "beta", "lift", "cd"} & (names | pure)
    ):
        return Proposal("ignore", PROPELLER, reason=Reason.PROPELLER)
    if "cd" in pure and column.unit in PURE and column.name.strip() in ("M", "N") and known.size:
        is_mach = one.text[0] == "M" and known.min() > 0.0 and (known.max() < MACH or REYNOLDS & names)
        if is_mach or (one.text[0] == "N" and known.min() >= 1.0 and np.all(known == np.round(known))):
            what = "a Mach number" if is_mach else "a count"
            note = f"{what} by its values beside coefficients; {one.text[0]} [{OPEN}] if it is the moment"
            return Proposal("ignore", note, note=note)
    if bare in vocabulary().lists["angle"] and "lift" in names and not (SIDEWAYS | {"alpha", "w", "N"}) & names:
        return replace(proposed(replace(column, name="alpha"), stated), certain=False, note="one angle beside lift")
    of_lift = column.unit in PURE and one.meaning is not None and one.meaning.name == "lift"
    if of_lift and {"beta", "v"} & names and not {"alpha", "w"} & names:
        return replace(one, text="ignore", why=f"{one.why}; no column alpha", note="no column alpha")
    alone = "drag" in names and not {"Y", "N", "side", "beta", "r"} & names
    if bare == "v" and alone and fits(column.unit, "speed") and known.size and known.min() >= 0.0:
        return Proposal(f"U [{column.unit}]", "its unit, over a resistance alone")
    froude = bare in ("fn", "fr") and column.unit in PURE
    if froude and known.size and 0.0 < known.min() <= known.max() < FROUDE:
        note = f"a Froude number by its values; Z [{OPEN}] if it is a force"
        return Proposal("ignore", note, note=note * (bare == "fn"))
    own = {vocabulary().coefficients.get(name) for name in pure}
    name = one.meaning.name if one.meaning else ""
    place = column.name.strip() in ("Y", "y") and column.unit in PURE and not {"beta", "v", "r"} & names
    twice = (
        name in ("X", "Z") or place or (name in own - {"lift", "drag"} and one.whole and "coefficient" not in one.text)
    )
    if {"lift", "drag"} <= own and name in FORCES and twice and not column.means:
        return Proposal("ignore", GIVEN_AS_COEFFICIENTS, note=GIVEN_AS_COEFFICIENTS)
    of_body = {"ca", "ct", "cn"} & pure if "cn" in pure else set()
    if len(of_body) > 1 and bare in of_body and {"cl", "cd"} <= pure:
        return Proposal("ignore", GIVEN_AS_COEFFICIENTS, note=GIVEN_AS_COEFFICIENTS)
    if bare == "cn" and column.unit in PURE and "alpha" in names and not SIDEWAYS & names and not {"cll", "ca"} & pure:
        return Proposal("", "N or -Z by its name: no column is of a motion sideways, so it may be the normal force")
    if bare == "ct" and {"cn", "ct"} == of_body and "alpha" in names:
        return Proposal("", "X or -X by its name beside Cn: positive forward or aft")
    if {"ca", "cn"} <= pure and bare in ("ca", "cn"):
        axial = bare == "ca"
        body, companion, way = ("X", "CN", "aft") if axial else ("Z", "CA", "up")
        along = 0.0 if frame is None else float(frame.rotation[0, 0] if axial else frame.rotation[2, 2])
        if not along:
            return Proposal("", f"its name beside {companion}: positive {way}, whatever the axes")
        # x forward and z down are +1: an axial force is positive aft, a normal force positive up.
        plain = proposed(replace(column, name=f"C{body.casefold()}"), stated)
        return replace(
            plain, text=f"{'-' * (along > 0.0)}{plain.text}", why=f"its name beside {companion}: positive {way}"
        )
    return one


def without_strangers(raw: RawTable, out: list[Proposal], confirmed: bool = False) -> list[Proposal]:
    """Of many columns that neither name nor unit says anything of, those that cannot be a setting are of no use.

    Nothing is left out where no force or no setting is known without them. Where a person said which column is a force, others with
    a word of the same force in their names are none, such as CL_XFOIL and Delta_CL; My_hull beside Fx_hull may be one.
    """
    strange = [
        i for i, one in enumerate(out)
        if not one.text and one.reason is Reason.UNKNOWN and raw.columns[i].name.strip() != "V"
    ]  # fmt: skip
    roles, many = {one.role for one in out}, len(strange) > MOST_ASKED
    if "force" in roles and roles & VARIED:
        named = [i for i, c in enumerate(raw.columns) if not _UNNAMED.fullmatch(c.name)]
        last = max(named, default=-1) if raw.header_line > 0 else -1  # one before it may be a setting
        left = {i: "a column without name" for i in strange if named and i not in named and i > last}
        forced = {i: raw.columns[i].name for i in strange if _has_a_force(raw.columns[i].name)}
        left |= {i: "spread of a force" for i, name in forced.items() if name.rpartition("_")[2] in _SPREAD}
        given = {one.meaning.name for one in out if one.meaning is not None and one.role == "force"}
        others = [i for i, name in forced.items() if confirmed and _forces_in(name) <= given]
        left |= dict.fromkeys(others, "another force is named")
        out = [replace(one, text="ignore", note=left[i]) if i in left else one for i, one in enumerate(out)]
        strange = [i for i in strange if i not in left]
    if len(strange) <= FEW_STRANGE or "force" not in roles or roles.isdisjoint(VARIED | {"speed"} if many else VARIED):
        return out
    settings = [c.values for c, one in zip(raw.columns, out, strict=True) if one.role in VARIED]
    plain = {c.name.strip() for c in raw.columns}
    series = Counter(_counted(raw.columns[i].name) for i in strange)
    idle = {
        i
        for i in strange
        if _is_of_a_force(raw.columns[i].name, plain)
        or series[_counted(raw.columns[i].name)] > FEW_STRANGE
        or any(
            fits(raw.columns[i].unit, what)
            for what in ("force", "moment", *["length"] * (not roles.isdisjoint(VARIED)))
        )
        or not _like_a_setting(raw.columns[i].values, settings)
    }
    if roles.isdisjoint(VARIED) and len({*strange} - idle) > FEW_STRANGE:
        idle = {*strange}
    return [
        replace(one, text="ignore", why=f"{UNKNOWN}, one of {len(strange)} such") if i in idle else one
        for i, one in enumerate(out)
    ]


def _counted(name: str) -> str:
    """A name of a series without its number: Cp_ of Cp_017; of others the name itself."""
    return re.sub(r"(?<=[A-Za-z_ ])[\d.]+$", "", name.strip())


def _is_of_a_force(name: str, names: Set[str]) -> bool:
    """Whether a name is that of a force of the table with a letter or words behind it: Cza beside Cz, Fx_visc beside Fx, Ma beside M,
    Cl_fine beside Cl_exp.
    """
    own = re.split(r"(?<=[a-z0-9])(?=[A-Z_ ])|[_ ]", name.strip())[0]
    forces = {base: named_as(base) for base in names if base != name.strip()}
    bases = {base for base, force in forces.items() if force in FORCES}
    companion = any(base.startswith(f"{own}_") and forces[base] == named_as(own) for base in bases)
    return companion or not bases.isdisjoint({own, own[:-1]})


def _has_a_force(name: str) -> bool:
    """Whether a word of a name is that of a force, or its last ones are of what no fit uses: Delta_CL, c_M_LE, XFOIL_CDp."""
    words = re.split(r"[_\W]+", re.sub(r"^c_", "c", name.strip()))
    tails = {named_as(" ".join(words[k:])) for k in range(len(words))}
    return "ignore" in tails or bool(_forces_in(name))


def _forces_in(name: str) -> set[str]:
    """Forces that words of a name are of."""
    words = re.split(r"[_\W]+", re.sub(r"^c_", "c", name.strip()))
    return {force for word in words if len(word) > 1 and (force := named_as(word)) in FORCES}


def _like_a_setting(values: Array, settings: Sequence[Array]) -> bool:
    """Whether a column takes few levels again and again, or goes along with a setting: left out, it would bend a slope unseen."""
    levels = np.unique(values[np.isfinite(values)]).size
    if 1 < levels <= values.size / 2:
        return True
    return levels > 1 and any(_together(values, s) > GOES_ALONG and not _same(values, s) for s in settings)


def _same(one: Array, other: Array) -> bool:
    """Whether two columns have the same numbers, a raw and a corrected angle: within `SAME` of the largest."""
    both = np.isfinite(one) & np.isfinite(other)
    largest = float(np.max(np.abs(other[both]), initial=0.0))
    return bool(both.any()) and float(np.median(np.abs(one - other)[both])) < SAME * largest


def _together(one: Array, other: Array) -> float:
    """Size of the correlation of two columns where both are known."""
    both = np.isfinite(one) & np.isfinite(other)
    if both.sum() < 3 or not np.ptp(one[both]) or not np.ptp(other[both]):
        return 0.0
    return float(abs(np.corrcoef(one[both], other[both])[0, 1]))


def by_stated_area(one: Proposal, known: Mapping[str, object]) -> Proposal:
    """A prime as a coefficient of the area that a person, or words that were accepted, say it was divided by."""
    area = known.get(AREA)
    if area is None or area == "prime":
        return one
    given = one.meaning
    if given is None or given.name not in FORCES or not given.primed:
        return one
    length = known.get(LENGTH_OF)
    moment = given.name in MOMENTS
    sizes = f"A={quantity(area, 'area')!r} m^2" + (
        f" L={OPEN if length is None else repr(quantity(length, 'length'))} m" if moment else ""
    )
    text = f"{str(given).partition(' [')[0].rstrip(chr(39))} [coefficient {sizes.replace(f'L={OPEN} m', f'L={OPEN}')}]"
    return replace(one, text=text, why=f"{one.why}, by 1/2 rho U^2 A{' L' * moment}, as said")


def _or_body_force(one: Proposal, other: str, body: str) -> Proposal:
    """A drag with the other reading that a force of the body beside it makes as likely: X differs by Y sin(beta)."""
    if not re.match(r"drag\b", one.text) or one.certain or one.note:
        return one
    x = one.text.replace("drag", "X", 1)
    note = f"along the flow, by its name; but {other} is {body} of the body. If this is along the body too: -{x} where x points forward, {x} where aft"
    return replace(one, why=f"{one.why}; {note}", note=note)


def _along_the_body(one: Proposal, column: RawColumn, place: str) -> Proposal:
    """A resistance as X of the body, reversed where it is above zero, for words over the table say body axes."""
    if not one.text.removeprefix("se_").startswith("drag") or "coefficient" in one.text or one.certain:
        return one
    known = column.values[np.isfinite(column.values)]
    positive = bool(known.size) and float(np.median(known)) > 0.0
    error = one.text.startswith("se_")
    text = one.text.replace("drag", "-X" if positive and not error else "X", 1)
    note = f"X of the body{', reversed' if positive and not error else ''}: {place}; {one.text} if it is along the flow"
    return Proposal(text, f"{one.why.partition(', along the flow')[0]}, {note}", note=note)


def _repeats(column: RawColumn) -> bool:
    cells = column.texts or tuple(column.values.tolist())
    return len(set(cells)) < len(cells)
