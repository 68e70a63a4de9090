"""A vehicle with an arm: frames and poses in space, joints, thrusts and paths in time, and a page that plays the motion.

The page needs no network and no other file: facets of the bodies, their poses row by row, and a script that draws them. It starts by
itself only where the reader's system does not ask for less motion.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from html import escape
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.patches import PathPatch
from numpy.typing import NDArray

from coeflab.arm import kane
from coeflab.arm.chain import Chain, Joint
from coeflab.arm.control import ControlledRun, gain_of, most_thrust
from coeflab.bodies.body import Body
from coeflab.bodies.mesh import silhouettes
from coeflab.bodies.shape import Cylinder, Ellipsoid, Part, Parts
from coeflab.core.text.bounded import own_text
from coeflab.core.texts import input_error
from coeflab.core.types import Array, brief, locking
from coeflab.motion.dynamics import rotations
from coeflab.motion.trajectory import Trajectory
from coeflab.report.document import Figure
from coeflab.report.figures import form_facets, part_pictures
from coeflab.report.figures.artists import text_width
from coeflab.report.figures.body import OBLIQUE
from coeflab.report.figures.body_view import Sheet, oblique, outline_path
from coeflab.report.figures.laws import Plot, Trace, laws_figure
from coeflab.report.figures.palette import COLOURS
from coeflab.report.figures.panel import WIDTH, drawing
from coeflab.report.figures.series import STYLES
from coeflab.report.figures.svg import settings, svg_text
from coeflab.report.figures.svg_file import sheet

TEMPLATE = Path(__file__).with_name("motion.html")
ALONG, AROUND = 10, 20  # facets of the hull that the page draws
FRAMES = 240  # at most, of a page
MARGIN, TALLEST, HEAD = 16.0, 300.0, 20.0
ARROW = 0.36  # m
EFFORT = {True: "{}.torque [N m]", False: "{}.force [N]"}
LETTERS = 7.5  # size of the names of axes, points
SLICES = 40  # of a cylinder that is seen in part


@brief
@dataclass(frozen=True, slots=True, eq=False)
@locking("hull time states")
class ArmMotion:
    """What a picture of a motion takes.

    Attributes
    ----------
    chain : Chain
    hull : (3,) array
        Semi-axes of the vehicle, m.
    time : (k,) array
        s.
    states : (k, 13 + 2 n) array
        As `coeflab.arm.kane.right_hand_side` has them; columns behind the joints are not looked at.
    """

    chain: Chain
    hull: Array
    time: Array
    states: Array

    @property
    def ends(self) -> Array:
        """(k, 3) end effector, NED, m."""
        return np.array([kane.end_in_earth(self.chain, s) for s in self.states])


def hull_of(body: Body) -> Array:
    """(3,) semi-axes, m, of the hull of a body whose reader is ``arm``."""
    hull = body.shape.parts[0].form if isinstance(body.shape, Parts) else None
    if not isinstance(hull, Ellipsoid):
        raise input_error("arm.without_ellipsoid_hull", column="reader", name=body.name)
    return np.asarray(hull.axes)


def parts_at(motion: ArmMotion, row: int) -> Parts:
    """Hull and the cylinders of the links' strips at a row, NED."""
    chain, state = motion.chain, motion.states[row]
    place, turn = state[:3], rotations(state[None, 3:7])[0]
    at = kane.pose(chain, state[7 : 7 + chain.count])
    parts = [Part("hull", Ellipsoid(*motion.hull.tolist()), place, turn)]
    for j, link in enumerate(chain.links, 1):
        for k, strip in enumerate(link.strips, 1):
            own = turn @ at.rotation[j]
            centre = place + turn @ at.origin[j] + own @ (strip.start + strip.end) / 2.0
            parts.append(
                Part(f"{link.name} {k}", Cylinder(strip.diameter / 2.0, strip.length), centre, own @ _along(strip.axis))
            )
    return Parts(tuple(parts))


def _along(axis: Array) -> Array:
    """(3, 3) rotation whose first column is the axis."""
    least = np.eye(3)[int(np.argmin(np.abs(axis)))]
    second = np.cross(axis, least)
    second /= np.linalg.norm(second)
    return np.column_stack([axis, second, np.cross(axis, second)])


# ---- in space ------------------------------------------------------------------------------------------------------


def poses_figure(motion: ArmMotion, anchor: str, title: str, caption: str) -> Figure:
    """Where the motion begins, its middle and its end, seen obliquely, with the path of the end effector."""
    rows = [0, len(motion.time) // 2, len(motion.time) - 1]
    shapes = [parts_at(motion, row) for row in rows]
    ends = motion.ends
    corners = np.vstack([*(_corners(s) for s in shapes), ends])
    flat = corners @ OBLIQUE.axes[:2].T
    room = (WIDTH - 4.0 * MARGIN) / len(rows)
    scale = float(min(room / np.ptp(flat[:, 0]), TALLEST / np.ptp(flat[:, 1])))
    height = scale * float(np.ptp(flat[:, 1])) + HEAD + 2.0 * MARGIN
    words = ", ".join(f"{motion.time[row]:.3g} s" for row in rows)
    description = f"Vehicle and arm at {words}; a line shows the path of the end effector."
    with settings():
        figure, axes = _paper(height)
        for k, (row, shape) in enumerate(zip(rows, shapes, strict=True)):
            left = MARGIN + k * (room + MARGIN)
            move = np.array([left - scale * flat[:, 0].min(), height - HEAD - MARGIN - scale * flat[:, 1].max()])
            drawn = Sheet(axes, OBLIQUE, scale, move, float(np.ptp(corners, axis=0).max()))
            _in_place(drawn, shape)
            axes.plot(*drawn.on_paper(ends).T, color=COLOURS["ink"], linewidth=1.1, zorder=3)
            axes.plot(*drawn.on_paper(ends[row]), marker="o", markersize=3.2, color=COLOURS["ink"], zorder=4)
            axes.text(left, height - 12.0, f"{motion.time[row]:.3g} s", color=COLOURS["ink"])
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, caption, description)


def _in_place(drawn: Sheet, shape: Parts) -> None:
    """The hull, and of every cylinder what neither lies in it nor behind it; cylinders nearer to the viewer later."""
    hull, *cylinders = shape.parts
    toward = drawn.view.axes[2]
    drawn.part(part_pictures.part_facets(hull), part_pictures.COLOUR_OF["ellipsoid"], False, True)
    for part in sorted(cylinders, key=lambda p: round(float(p.centre @ toward), 9)):
        form = part.form
        if not isinstance(form, Cylinder):
            continue
        facets = form_facets.cut_cylinder_facets(form.radius, form.length, SLICES) @ part.rotation.T + part.centre
        seen = facets[in_sight(facets.mean(axis=1), hull, toward)]
        if len(seen):
            drawn.part(seen, part_pictures.COLOUR_OF["cylinder"], False, False)


def in_sight(points: Array, hull: Part, toward: Array) -> NDArray[np.bool_]:
    """Which (n, 3) points a viewer sees past an ellipsoid: the ray toward the viewer does not leave it."""
    axes = np.asarray(hull.form.axes) if isinstance(hull.form, Ellipsoid) else np.zeros(3)
    start, ray = (points - hull.centre) @ hull.rotation / axes, toward @ hull.rotation / axes
    a, b, c = ray @ ray, start @ ray, np.sum(start**2, axis=1) - 1.0
    within = b * b - a * c
    return np.asarray((within <= 0.0) | (np.sqrt(np.maximum(within, 0.0)) <= b))


FROM_PORT = oblique("from ahead, port and above", -62.0, 22.0)


def frames_figure(motion: ArmMotion, anchor: str, caption: str) -> Figure:
    """The frames of the chain on the bodies that carry them, at the first row."""
    chain = motion.chain
    shape = parts_at(motion, 0)
    at = kane.pose(chain, motion.states[0, 7 : 7 + chain.count])
    frames = [(chain.attachment, chain.mount), *zip(at.origin[1:], at.rotation[1:], strict=True)]
    view, reach = FROM_PORT, [ARROW * (1.0 - 0.2 * k) for k in range(len(frames))]
    tips = np.array([origin + ARROW * axis for origin, turn in frames for axis in np.asarray(turn).T])
    earth = np.array([[0.9, -1.0, 0.7]])
    corners = np.vstack([_corners(shape), tips, earth, earth + ARROW * np.eye(3)])
    flat = corners @ view.axes[:2].T
    scale = float(min((WIDTH - 4.0 * MARGIN) / np.ptp(flat[:, 0]), 1.2 * TALLEST / np.ptp(flat[:, 1])))
    height = scale * float(np.ptp(flat[:, 1])) + 3.0 * MARGIN
    title = "Coordinate system of the model"
    description = (
        f"Vehicle, {chain.count} links and {chain.count + 1} frames, x, y and z of each as arrows; frame 0 where the arm is mounted; north, "
        "east and down beside them; the vector c₀ from the vehicle's centre of mass to frame 0."
    )
    with settings():
        figure, axes = _paper(height)
        middle = (WIDTH - scale * float(np.ptp(flat[:, 0]))) / 2.0
        move = np.array([middle - scale * flat[:, 0].min(), 1.5 * MARGIN - scale * flat[:, 1].min()])
        drawn = Sheet(axes, view, scale, move, float(np.ptp(corners, axis=0).max()))
        _pale(drawn, shape)
        taken: list[Array] = []
        named = []
        for number, (origin, turn) in enumerate(frames):
            own = tuple(axis + _index(number) for axis in "xyz")
            named += _triad(drawn, origin, turn, own, "ink", reach[number], taken)
        named += _triad(drawn, earth[0], np.eye(3), ("north", "east", "down"), "b", ARROW, taken)
        start, end = drawn.on_paper(np.zeros(3)), drawn.on_paper(chain.attachment)
        _arrow(drawn, start, end, "b")
        named.append((start, start - end, "c" + _index(0), "b"))
        for tip, along, name, colour in named:
            _named(drawn, tip, along, name, colour, taken)
        svg = svg_text(figure, anchor, title, description)
    return Figure(anchor, svg, title, caption, description)


def _paper(height: float) -> tuple[Any, Any]:
    """A drawing whose axes are points."""
    figure = drawing(height)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set_axis_off()
    axes.set_xlim(0.0, WIDTH)
    axes.set_ylim(0.0, height)
    return figure, axes


def _index(number: int) -> str:
    return str(number).translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))


def _triad(
    drawn: Sheet, origin: Array, turn: Array, names: Sequence[str], colour: str, reach: float, taken: list[Array]
) -> list[tuple[Array, Array, str, str]]:
    """Draw three arrows, whose boxes join those taken; what is to be named: tip, direction, name, colour."""
    out = []
    start = drawn.on_paper(origin)
    for name, axis in zip(names, np.asarray(turn).T, strict=True):
        tip = drawn.on_paper(origin + reach * axis)
        along = tip - start
        if float(np.linalg.norm(along)) < 6.0:  # toward the viewer
            continue
        _arrow(drawn, start, tip, colour)
        taken += [np.concatenate([p - 1.5, p + 1.5]) for p in np.linspace(start, tip, 12)]
        out.append((tip, along, name, colour))
    return out


def _named(drawn: Sheet, tip: Array, along: Array, name: str, colour: str, taken: list[Array]) -> None:
    """A name beyond a tip, beside it or farther out where names or arrows stand; its box (left, bottom, right, top) joins them."""
    ahead = along / float(np.linalg.norm(along))
    aside = np.array([-ahead[1], ahead[0]])
    half = np.array([text_width(name, LETTERS) / 2.0 + 1.0, 0.5 * LETTERS])
    boxes = []
    for far in (8.0, 14.0, 20.0):
        for out in (0.0, 9.0, -9.0, 16.0, -16.0):
            at = tip + far * ahead + out * aside
            boxes.append(np.concatenate([at - half, at + half]))
    free = (box for box in boxes if not any(np.all(box[:2] < b[2:]) and np.all(b[:2] < box[2:]) for b in taken))
    box = next(free, boxes[0])
    taken.append(box)
    x, y = (box[:2] + box[2:]) / 2.0
    drawn.axes.text(x, y, name, color=COLOURS[colour], ha="center", va="center", fontsize=LETTERS, zorder=6)


def _arrow(drawn: Sheet, start: Array, end: Array, colour: str) -> None:
    look = {"arrowstyle": "-|>", "color": COLOURS[colour], "linewidth": 1.0, "shrinkA": 0.0, "shrinkB": 0.0}
    drawn.axes.annotate("", (end[0], end[1]), (start[0], start[1]), arrowprops=look, zorder=5)


def _pale(drawn: Sheet, shape: Parts) -> None:
    """Parts as outlines with a pale fill, so that what is written over them can be read."""
    for part in shape.parts:
        path = outline_path(
            silhouettes.convex_outline(part_pictures.part_facets(part).reshape(-1, 3), drawn.frame), drawn.move
        )
        if path is not None:
            drawn.axes.add_patch(PathPatch(path, facecolor=COLOURS["band"], edgecolor="none", alpha=0.25, zorder=2))
            drawn.axes.add_patch(PathPatch(path, facecolor="none", edgecolor=COLOURS["muted"], linewidth=0.8, zorder=2))


def _corners(shape: Parts) -> Array:
    """Corners of boxes about the parts."""
    out = []
    for part in shape.parts:
        form = part.form
        if isinstance(form, Cylinder):
            size = np.array([form.length, 2.0 * form.radius, 2.0 * form.radius])
        elif isinstance(form, Ellipsoid):
            size = 2.0 * np.asarray(form.axes)
        else:
            size = np.ones(3)
        out.append(form_facets.box_facets(size).reshape(-1, 3) @ part.rotation.T + part.centre)
    return np.vstack(out)


# ---- in time -------------------------------------------------------------------------------------------------------


def joint_plots(
    joints: Sequence[Joint], time: Array, positions: Array, efforts: Array, asked: Array | None = None
) -> tuple[Plot, ...]:
    """Positions and efforts (k, n) of joints: angles and torques, travels and forces, each kind in panels of its own.

    Dots, one in eight rows, where a position was asked for.
    """
    plots = []
    for turns, place, effort, scale in (
        (True, "angle  [deg]", "torque  [N m]", 180.0 / np.pi),
        (False, "travel  [mm]", "force  [N]", 1e3),
    ):
        own = [k for k, joint in enumerate(joints) if joint.turns is turns]
        if not own:
            continue
        found = [Trace(joints[k].name, time, scale * positions[:, k], k % len(STYLES)) for k in own]
        if asked is not None:
            found += [_asked(joints[k].name, time, scale * asked[:, k]) for k in own]
        acting = [Trace(joints[k].name, time, efforts[:, k], k % len(STYLES)) for k in own]
        plots += [
            Plot(place, "time  [s]", tuple(found), 90.0, is_scaled=False),
            Plot(effort, "time  [s]", tuple(acting), 90.0, is_scaled=False),
        ]
    return (*plots[:-1], replace(plots[-1], is_scaled=True)) if plots else ()


def _asked(name: str, time: Array, values: Array) -> Trace:
    """Dots, one in eight rows, where something was asked for: elsewhere it is not a number."""
    there = np.flatnonzero(np.isfinite(values))[::8]
    return Trace("asked for", time[there], values[there], -1, "filled", (name,) * len(there))


def joints_figure(run: ControlledRun, anchor: str, title: str) -> Figure:
    """Joint positions beside those asked for, and the torques and forces of the drives."""
    joints = run.chain.joints
    plots = joint_plots(joints, run.time, run.q, run.torque, run.wanted)
    return laws_figure(
        anchor, title, "Joint positions, with dots where the track asks for them, and torques of the drives.",
        f"{len(plots)} panels over {run.time[-1]:.3g} s: positions and torques of {', '.join(j.name for j in joints)}.", plots,
    )  # fmt: skip


def station_figure(runs: Sequence[tuple[str, ControlledRun]], anchor: str, title: str, caption: str) -> Figure:
    """How far vehicle and end effector are from where they belong, of several runs."""
    rows: tuple[tuple[str, Callable[[ControlledRun], Array]], ...] = (
        ("off station  [mm]", lambda r: 1e3 * r.apart),
        ("turned  [deg]", lambda r: np.degrees(r.turned)),
        ("end effector off  [mm]", lambda r: 1e3 * r.end_apart),
    )
    plots = [
        Plot(
            name, "time  [s]", tuple(Trace(words, r.time, value(r), i % len(STYLES)) for i, (words, r) in enumerate(runs)), 84.0,
            is_scaled=k == len(rows) - 1,
        )
        for k, (name, value) in enumerate(rows)
    ]  # fmt: skip
    description = f"Three panels over time for {', '.join(words for words, _ in runs)}."
    return laws_figure(anchor, title, caption, description, plots)


def thrust_figure(run: ControlledRun, anchor: str, title: str, caption: str) -> Figure:
    """Thrusts given, and those asked for as dots: the first half of the thrusters above the others."""
    names = [one.name for one in run.chain.thrusters]
    plots = _thrust_plots(names, run.time, run.thrust, run.ordered)
    words = f"Thrusts of {len(names)} thrusters over time: {', '.join(names).replace('_', ' ')}."
    return laws_figure(anchor, title, caption, words, plots)


def _thrust_plots(names: Sequence[str], time: Array, thrust: Array, ordered: Array) -> list[Plot]:
    """Thrusts (k, m), and those asked for as dots."""
    shown, half, plots = [name.replace("_", " ") for name in names], -(-len(names) // 2), []
    for part in (range(half), range(half, len(names))):
        lines = [Trace(shown[k], time, thrust[:, k], k % len(STYLES)) for k in part]
        dots = [_asked(shown[k], time, ordered[:, k]) for k in part if np.isfinite(ordered[:, k]).any()]
        if lines:
            last = part.stop == len(names)
            plots.append(Plot("thrust  [N]", "time  [s]", (*lines, *dots), 96.0, is_scaled=last))
    return plots


def path_figure(found: Array, asked: Array | None, anchor: str, title: str, caption: str) -> Figure:
    """Path of the end effector (k, 3), NED; dots where it was asked for.

    Down, drawn downward, and one level axis, over the level axis along which it goes farthest.
    """
    names = ("north", "east", "down")
    across, aside = sorted(range(2), key=lambda k: (-round(float(np.ptp(found[:, k])), 6), k))
    others = (aside, 2)
    plots = []
    for k in others:
        traces = [Trace("end effector", found[:, across], found[:, k], 0)]
        if asked is not None:
            there = np.flatnonzero(np.isfinite(asked[:, k]))[::6]
            traces.append(Trace("asked for", asked[there, across], asked[there, k], -1, "filled"))
        plots.append(Plot(f"{names[k]}  [m]", f"{names[across]}  [m]", tuple(traces), is_scaled=k == 2))
    words = f"The path of the end effector: {names[others[0]]} and {names[others[1]]} over {names[across]}."
    return laws_figure(anchor, title, caption, words, plots)


def simulated(chain: Chain, hull: Array, trajectory: Trajectory) -> ArmMotion:
    """The motion of a `coeflab simulate`, as pictures take it."""
    n, rows = chain.count, len(trajectory.time)
    q = [trajectory.controls[f"{j.name} [{'rad' if j.turns else 'm'}]"] for j in chain.joints]
    states = np.hstack([trajectory.position, trajectory.attitude, np.reshape(q, (n, rows)).T, np.zeros((rows, 6 + n))])
    return ArmMotion(chain, hull, trajectory.time, states)


def simulated_sheet(motion: ArmMotion, trajectory: Trajectory) -> bytes:
    """A motion of a `coeflab simulate` as one SVG file: poses, vehicle, joints, path of the end effector, thrusts.

    Dots where a controller asks for joints, path and thrusts; how near thrusters are to their largest steady thrust.
    """
    joints, t = motion.chain.joints, motion.time
    columns = trajectory.controls
    selected = "end.north.wanted [m]" in columns
    dots = ", with dots where the controller asks for them" if selected else ""

    def stacked(names: Sequence[str]) -> Array:
        return np.column_stack([columns[name] for name in names])

    named = [f"{j.name}{{}} [{'rad' if j.turns else 'm'}]" for j in joints]
    efforts = stacked([EFFORT[j.turns].format(j.name) for j in joints])
    asked = stacked([name.format(".wanted") for name in named]) if selected else None
    plots = joint_plots(joints, t, stacked([name.format("") for name in named]), efforts, asked)
    to = stacked([f"end.{axis}.wanted [m]" for axis in ("north", "east", "down")]) if selected else None
    figures = [
        poses_figure(
            motion,
            "arm-poses",
            "Poses, and the path of the end effector",
            "At the beginning, halfway in time and at the end.",
        ),
        _vehicle_figure(trajectory, selected),
        laws_figure(
            "arm-joints",
            "Joints",
            f"Positions{dots}, and torques and forces, over time.",
            f"{len(plots)} panels over time: {', '.join(j.name for j in joints)}.",
            plots,
        ),
        path_figure(motion.ends, to, "arm-path", "Path of the end effector", f"North, east and down{dots}."),
    ]
    names = [one.name for one in motion.chain.thrusters]
    thrust = stacked([f"{name} [N]" for name in names]) if names else np.zeros((len(t), 0))
    if np.any(thrust != 0.0):
        wanted = stacked([f"{name}.wanted [N]" for name in names]) if selected else np.full(thrust.shape, np.nan)
        pushed = _thrust_plots(names, t, thrust, wanted)
        density = motion.chain.density
        most = np.array([most_thrust(one, gain_of(one, density), density) for one in motion.chain.thrusters])
        caption = f"Thrusts over time{dots}."
        if selected and np.isfinite(most).all():
            share = Trace("largest of all", t, np.max(100.0 * np.abs(wanted) / most, axis=1), 0)
            pushed[-1] = replace(pushed[-1], is_scaled=False)
            pushed.append(Plot("asked for  [% of largest]", "time  [s]", (share,), 84.0))
            caption += " Below, of the thruster that is nearest to its largest steady thrust, which is 100 %."
        figures.append(laws_figure("arm-thrust", "Thrust", caption, f"Thrusts of {', '.join(names)}.", pushed))
    return sheet([[f] for f in figures])


def _vehicle_figure(trajectory: Trajectory, is_held: bool) -> Figure:
    """Place and attitude of the vehicle over time."""
    t, scale, unit = trajectory.time, 1e3 if is_held else 1.0, "mm" if is_held else "m"
    angles = np.degrees(trajectory.angles)
    plots = [
        Plot(
            f"place  [{unit}]", "time  [s]",
            tuple(Trace(n, t, scale * trajectory.position[:, k], k) for k, n in enumerate(("north", "east", "down"))), is_scaled=False,
        ),
        Plot(
            "attitude  [deg]", "time  [s]", tuple(Trace(n, t, angles[:, k], k) for k, n in enumerate(("roll", "pitch", "yaw"))),
        ),
    ]  # fmt: skip
    caption = "Place of its centre of mass from where that began, and attitude, over time."
    return laws_figure("arm-vehicle", "Vehicle", caption, "Two panels over time: place, attitude.", plots)


# ---- a page that plays it ------------------------------------------------------------------------------------------


def animation(motion: ArmMotion, title: str, description: str) -> bytes:
    """A page, HTML, that plays a motion in space; equal input gives equal bytes.

    Parameters
    ----------
    motion : ArmMotion
        Of more than 240 rows as many are shown, at equal distances.
    title : str
    description : str
        What the motion is, in a sentence: read aloud in the place of the picture.
    """
    rows = np.unique(np.round(np.linspace(0, len(motion.time) - 1, min(FRAMES, len(motion.time)))).astype(int))
    first = parts_at(motion, 0)
    bodies = []
    for k, part in enumerate(first.parts):
        own = _hull_facets(motion.hull) if k == 0 else _tube(part)
        bodies.append(
            {
                "colour": COLOURS["c" if k == 0 else "a"],
                "facets": own.round(4).tolist(),
                "normals": form_facets.normals(own).round(3).tolist(),
            }
        )
    poses = []
    for row in rows:
        shape = parts_at(motion, int(row))
        poses.append(
            [[*np.round(p.rotation, 4).ravel().tolist(), *np.round(p.centre, 4).tolist()] for p in shape.parts]
        )
    ends = motion.ends[rows]
    corners = np.vstack(
        [*(_corners(parts_at(motion, int(r))) for r in (rows[0], rows[len(rows) // 2], rows[-1])), ends]
    )
    middle = (corners.max(axis=0) + corners.min(axis=0)) / 2.0
    data = {
        "time": np.round(motion.time[rows], 4).tolist(), "bodies": bodies, "poses": poses, "ends": np.round(ends, 4).tolist(),
        "middle": np.round(middle, 3).tolist(), "size": round(float(np.linalg.norm(np.ptp(corners, axis=0))), 3),
    }  # fmt: skip
    text = json.dumps(data, separators=(",", ":"), allow_nan=False).replace("</", "<\\/")
    page = own_text(TEMPLATE)
    for name, value in (("TITLE", escape(title)), ("SAID", escape(description)), ("DATA", text)):
        page = page.replace(f"@@{name}@@", value)
    return page.encode()


def _tube(part: Part) -> Array:
    form = part.form
    return (
        form_facets.cylinder_facets(form.radius, form.length)
        if isinstance(form, Cylinder)
        else form_facets.box_facets(np.ones(3))
    )


def _hull_facets(axes: Array) -> Array:
    """(n, 4, 3) facets of an ellipsoid, coarser than those of the drawings."""
    theta = np.linspace(0.0, np.pi, ALONG + 1)
    phi = 2.0 * np.pi * np.arange(AROUND + 1) / AROUND
    x, r = -np.cos(theta), np.sin(theta)
    grid = np.stack(
        [np.tile(x[:, None], (1, AROUND + 1)), r[:, None] * np.cos(phi), r[:, None] * np.sin(phi)], axis=-1
    ) * axes  # fmt: skip
    facets = np.stack([grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]], axis=2)
    return np.asarray(facets.reshape(-1, 4, 3))
