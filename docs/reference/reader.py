"""A reader of coeflab's parameter files in plain Python: the force law of docs/force_law.md, rule by rule, nothing of coeflab.

``python reader.py FILE.parameters.json < states.json`` prints forces and accelerations. (1) to (31) are the rules of that page.
"""

import itertools
import json
import math
import re
import sys

BODY, MOTION, CONTROLS, SLOW = "XYZKMN", "uvwpqr", ("dr", "ds", "db"), 1e-9
PLACES = {"C_D": "D", "C_S": "S", "C_L": "L", "C_l": "K", "C_m": "M", "C_n": "N"}
TURNS = {
    "DX": "",
    "DY": "v",
    "DZ": "w",
    "SX": "v",
    "SY": "",
    "SZ": "vw",
    "LX": "w",
    "LZ": "",
}  # what (13) makes of them


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def moved(names):  # what a product or a table is about: incidence is v and w, u and U are the speed of all
    return {{"alpha": "w", "beta": "v"}.get(n, n) for n in names} - {"u"}


def pushed(matrix, nu):  # Kirchhoff: what momenta that move with the body exert on it
    h = [dot(row, nu) for row in matrix]
    both = zip(cross(nu[3:], h[3:]), cross(nu[:3], h[:3]))
    return [-x for x in cross(nu[3:], h[:3])] + [-a - b for a, b in both]


def definite(matrix, at, least=0.0):  # by Cholesky, scaled to a unit diagonal; a row without a diagonal must be zero
    live = [i for i in at if matrix[i][i] > 0.0]
    if any(matrix[i][i] < 0.0 or (i not in live and (least == 0.0 or any(matrix[i]))) for i in at):
        return False
    low = {}
    for i in live:
        for j in (j for j in live if j <= i):
            scale = math.sqrt(matrix[i][i] * matrix[j][j])
            left = matrix[i][j] / scale + least * (i == j) - sum(low[i, k] * low[j, k] for k in live if k < j)
            if i == j and left <= 0.0:
                return False
            low[i, j] = math.sqrt(left) if i == j else left / low[j, j]
    return True


def solved(matrix, right):  # Gauss, largest pivot first
    rows = [[*row, x] for row, x in zip(matrix, right)]
    for i in range(len(rows)):
        best = max(range(i, len(rows)), key=lambda k: abs(rows[k][i]))
        rows[i], rows[best] = rows[best], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        rows = [row if k == i else [x - row[i] * y for x, y in zip(row, rows[i])] for k, row in enumerate(rows)]
    return [row[-1] for row in rows]


def held(x, domain):  # the point where a table is read, the share of the free continuation, whether it is inside
    spaces, low, high = domain["half_spaces"], domain["low"], domain["high"]
    if all(dot(s, x) + s[-1] <= 1e-9 * max(1.0, abs(s[-1])) for s in spaces):
        return x, 0.0, True
    size = [b - a if b > a else 1.0 for a, b in zip(low, high)]  # (20) distances are in widths of the box
    y, faces, best = [(v - a) / s for v, a, s in zip(x, low, size)], [], None
    for *a, b in spaces:
        normal = [n * s for n, s in zip(a, size)]
        long = math.hypot(*normal)
        faces.append(([n / long for n in normal], -(b + dot(a, low)) / long))
    for chosen in (c for k in range(len(x)) for c in itertools.combinations(faces, k + 1)):
        basis = []  # (19) the nearest foot, on a face, edge or corner, that lies in the hull
        for n, c in chosen:
            for q, e in basis:
                n, c = [u - dot(n, q) * v for u, v in zip(n, q)], c - dot(n, q) * e
            if math.hypot(*n) > 1e-9:
                basis.append(([u / math.hypot(*n) for u in n], c / math.hypot(*n)))
        foot = [v + sum((e - dot(q, y)) * q[i] for q, e in basis) for i, v in enumerate(y)]
        if len(basis) == len(chosen) and all(dot(n, foot) - c <= 1e-9 for n, c in faces):
            best = min([(math.dist(foot, y), foot), *([best] if best else [])])
    near = [a + s * v if b > a else a for a, b, s, v in zip(low, high, size, best[1])]
    t = min(1.0, math.dist([(v - a) / s for v, a, s in zip(near, low, size)], y) / 0.1)
    if any(v != w and a == b for v, w, a, b in zip(near, x, low, high)):
        t = 1.0
    return near, (1.0 - t * t * (3.0 - 2.0 * t)) if domain["extrapolation"] == "taper" else 0.0, False  # (22)


class Vehicle:
    def __init__(self, f):
        self.f, at = f, f["conditions"]
        self.rho, self.length, self.terms, stated = at["density"], f["scaling"]["length"], [], {}
        for c in f["coefficients"]:
            symbol = c["symbol"].rstrip("'")
            read = re.findall(r"\|(\w+?)\||(dr|ds|db|[uvwpqr]dot|[uvwpqr])", symbol[1:])
            factors = [(a or b, 1, bool(a)) for a, b in read]
            names = [n for n, _, _ in factors]
            k = 2 + (symbol[0] in "KMN") + sum((n[0] in "pqr") + n.endswith("dot") for n in names if n not in CONTROLS)
            unit = 0.5 * self.rho * self.length**k  # (1)
            if c["value"] is None:  # (2)
                continue
            if any(n.endswith("dot") for n in names):
                if len(names) == 1:  # (24) the added mass is the negative of an acceleration derivative
                    stated[BODY.index(symbol[0]), MOTION.index(names[0][0])] = -c["value"] * unit
                continue
            power, value = 2 - sum(n in MOTION for n in names), c["value"] * unit
            if c.get("law") == "rest" and c.get("value_si") is not None:  # (3)
                power, value = 0, c["value_si"]
            self.terms.append((symbol[0], value, power, factors))
        self.tables = [m for m in f.get("models", []) if self.place(m)]
        self.unused()
        self.on = [self.acts(m) for m in self.tables]
        self.inertia(stated)
        self.ideal()

    def place(self, m):
        name = m["response"].rstrip("'")
        return PLACES.get(name, name if name in (*BODY, *"DSL") else "")

    def main(self, m):
        return {"D": "X", "S": "Y", "L": "Z"}.get(self.place(m), self.place(m))

    def over(self, m):
        each = [moved(x["variable"] for x in t["factors"]) for t in m["terms"]]
        return set.intersection(*each), moved(v["name"] for v in m["variables"])

    def unused(self):
        for a, b in itertools.combinations(list(self.tables), 2):  # (9) of two tables the one over more variables
            (na, va), (nb, vb) = self.over(a), self.over(b)
            if a in self.tables and b in self.tables and self.main(a) == self.main(b) and na | nb <= va & vb:
                if not (va < vb or vb < va):
                    raise ValueError(
                        "two tables of one component overlap, and neither is over all variables of the other"
                    )
                self.tables.remove(a if va < vb else b)
        for m in list(self.tables):
            need, all_of = self.over(m)
            # (10) an increment over a control speaks of products with that control alone
            rivals = [t for t in self.terms if t[0] == self.main(m) and need <= moved(n for n, _, _ in t[3]) <= all_of]
            if rivals and set().union(*(moved(n for n, _, _ in t[3]) for t in rivals)) >= all_of:  # (8)
                self.tables.remove(m)
            elif rivals:  # (7)
                self.terms = [t for t in self.terms if t not in rivals]

    def acts(self, m):  # the rows of the force that a table acts in
        place, out = self.place(m), []
        if place in BODY:
            return [BODY.index(place)]
        for i, c in ((i, c) for i, c in enumerate("XYZ") if place + c in TURNS):
            made = self.over(m)[0] | set(TURNS[place + c])
            body = any(t[0] == c and moved(n for n, _, _ in t[3]) == made for t in self.terms)
            body = body or any(self.place(o) == c and self.over(o)[0] <= made <= self.over(o)[1] for o in self.tables)
            out += [] if body else [i]  # (12)
        return out

    def inertia(self, stated):
        _f, mass, hull = self.f, self.f["mass"], self.f.get("added_mass")
        zero = [[0.0] * 6 for _ in range(6)]
        self.rigid, self.known, self.centre = [row[:] for row in zero], [], [0.0] * 3
        if mass:
            m = mass["mass"]
            self.centre = mass.get("centre") or [mass["mass_moment"] / m, 0.0, 0.0]  # (26)
            x, y, z = (m * c for c in self.centre)
            j = mass.get("inertia") or 0.0
            i = mass.get("inertia_matrix") or [[0, 0, 0], [0, j, 0], [0, 0, j]]
            self.known = [0, 1, 2] + ([3, 4, 5] if mass.get("inertia_matrix") else [4, 5] if j else [])
            self.rigid = [
                [m, 0, 0, 0, z, -y], [0, m, 0, -z, 0, x], [0, 0, m, y, -x, 0],
                [0, -z, y, *i[0]], [z, 0, -x, *i[1]], [-y, x, 0, *i[2]],
            ]  # fmt: skip
        ratio = self.rho / hull["density"] if hull else 0.0  # (23)
        computed = (
            [[ratio * (hull["matrix"][i][j] + hull["matrix"][j][i]) / 2 for j in range(6)] for i in range(6)]
            if hull
            else zero
        )
        added = [row[:] for row in computed]
        for (i, j), x in stated.items():  # (25) on both sides of the diagonal, or the mean of both
            added[i][j] = added[j][i] = (x + stated.get((j, i), x)) / 2.0

        def fits(a):
            whole = [
                [a[i][j] + (self.rigid[i][j] if {i, j} <= set(self.known) else 0.0) for j in range(6)] for i in range(6)
            ]
            return (
                min(a[i][i] for i in range(6)) >= 0.0
                and definite(whole, range(6), 1e-9)
                and definite(whole, self.known)
            )

        if not fits(added):  # (27)
            alone = [[x if i == j else 0.0 for j, x in enumerate(row)] for i, row in enumerate(added)]
            added = computed if hull else alone if mass else added
        self.added, self.moves = added, hull or fits(added)

    def ideal(self):
        self.open = (
            {(i, j, k) for i in range(6) for j in range(6) for k in range(j, 6)} if self.f.get("added_mass") else set()
        )
        for (
            c,
            _,
            power,
            factors,
        ) in self.terms:  # (14) a product that a coefficient speaks of, with U for u, zero or not
            names = [n for n, _, _ in factors]
            plain = not any(a or n in CONTROLS for n, _, a in factors)
            if plain and len(names) + power == 2 and power >= 0:
                pair = sorted([0] * power + [MOTION.index(n) for n in names])
                self.open.discard((BODY.index(c), *pair))
        for m, on in zip(
            self.tables, self.on
        ):  # (15) every product of u and its own; (16) unless it has no potential part
            need, all_of = self.over(m)
            if m.get("contains_potential", True) and not need & set(CONTROLS):
                at = [0] + [MOTION.index(n) for n in all_of if n in MOTION]
                self.open -= {(i, j, k) for i in on for j in at for k in at}

    def force(self, nu, delta):
        u, v, w = nu[:3]
        speed = math.sqrt(u * u + v * v + w * w)
        slow = max(speed, SLOW)  # (5)
        alpha, beta = (
            math.atan2(w + 0.0, u + 0.0),
            math.asin(max(-1.0, min(1.0, v / speed))) if speed > 0.0 else 0.0,
        )  # (11)
        base = {**dict(zip(MOTION, nu)), **dict(zip(CONTROLS, delta)), "alpha": alpha, "beta": beta}
        total, q = [0.0] * 6, 0.5 * self.rho * speed**2
        ca, sa, cb, sb = math.cos(alpha), math.sin(alpha), math.cos(beta), math.sin(beta)
        along = {"D": (-ca * cb, -sb, -sa * cb), "S": (-ca * sb, cb, -sa * sb), "L": (sa, 0.0, -ca)}  # (13)

        def product(factors, values):
            return math.prod(abs(values[n]) ** k if a else values[n] ** k for n, k, a in factors)

        for c, value, power, factors in self.terms:
            course = max(-1.0, min(1.0, 10.0 * u / slow)) if c == "X" and not factors and power == 2 else 1.0  # (4)
            total[BODY.index(c)] += (
                value * (speed**power if power >= 0 else slow**power) * course * product(factors, base)
            )
        for m, on in zip(self.tables, self.on):
            names = [x["name"] for x in m["variables"]]
            scales = [  # (17) a primed variable is by the present speed
                (1.0 if n in "uvw" else self.length) / slow if x["unit"] == "1" and n in MOTION else 1.0
                for n, x in zip(names, m["variables"])
            ]
            point = [base[n] * s for n, s in zip(names, scales)]
            near, free, inside = held(point, m["domain"])
            place = self.place(m)
            unit = 1.0  # (18) a coefficient by an area, or by L^2; moments by L too
            if m["unit"] == "1":
                unit = (
                    q
                    * (m["area"]["value"] if m.get("area") else self.length**2)
                    * (self.length if place in "KMN" else 1.0)
                )
            if not inside and m["domain"]["extrapolation"] == "refuse" and (speed > SLOW or m["unit"] != "1"):  # (21)
                return None
            sums = [
                sum(t["value"] * product([(x["variable"], x["power"], x.get("absolute", False)) for x in t["factors"]],
                                         dict(zip(names, p))) for t in m["terms"] if t["value"] is not None)
                for p in (near, point)
            ]  # fmt: skip
            for i in on:
                way = along[place][i] if place in along else 1.0
                total[i] += way * unit * (sums[0] + free * (sums[1] - sums[0]))
        if self.open:  # -C_A(nu) nu, product by product
            for j, k in ((j, k) for j in range(6) for k in range(j, 6)):
                one = [[float(i == n) for i in range(6)] for n in (j, k)]
                both = pushed(self.added, [a + b for a, b in zip(*one)]) if j != k else [0.0] * 6
                alone = [pushed(self.added, x) for x in one]
                for i in range(6):
                    share = both[i] - alone[0][i] - alone[1][i] if j != k else alone[0][i]
                    total[i] += share * nu[j] * nu[k] if (i, j, k) in self.open else 0.0
        return total

    def thrust(self, commands):
        out = [commands.get("thrust", 0.0)] + [0.0] * 5

        def at(curve, x):  # (29) the ends hold beyond them; between segments there is nothing
            parts = curve["segments"]
            x = min(max(x, parts[0]["low"]), parts[-1]["high"])
            of = [s for s in parts if s["low"] <= x <= s["high"]][:1]
            return sum(c * x**k for s in of for k, c in enumerate(s["coefficients"]))

        for t in self.f.get("thrusters", []):
            n, way, axis = commands.get(t["name"], 0.0), t["direction"], t.get("tilt_axis")
            if axis:  # (30) the direction turns about the axis, right-handed, then the thrust acts at the position
                angle = min(
                    max(commands.get(t["name"] + ".tilt", 0.0), t.get("tilt_low", 0.0)), t.get("tilt_high", 0.0)
                )
                c, s, on = math.cos(angle), math.sin(angle), dot(axis, way)
                way = [c * a + s * b + (1 - c) * on * k for a, b, k in zip(way, cross(axis, way), axis)]
            push = [at(t["curve"], n) * x for x in way]
            torque = t.get("handedness", 1) * at(t["torque_curve"], n) if t.get("torque_curve") else 0.0
            turn = [a + torque * b for a, b in zip(cross(t["position"], push), way)]
            out = [a + b for a, b in zip(out, push + turn)]
        return out

    def actual(self, state):  # (31) on the way from what was before to the command
        out = dict(state.get("commands", {}))
        for t in self.f.get("thrusters", []):
            if t.get("lag") and "since" in state:
                order, before = out.get(t["name"], 0.0), state.get("before", {}).get(t["name"], 0.0)
                out[t["name"]] = order + (before - order) * math.exp(-state["since"] / t["lag"])
        return out

    def afloat(self, attitude):
        w, x, y, z = attitude
        down = [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]
        h, m = self.f.get("hydrostatics"), self.f["mass"]["mass"]
        if not h:  # (28)
            return [0.0] * 6
        g = h.get("gravity", 9.80665)
        weight, lift = m * g, self.rho * g * h["volume"]
        arm = [weight * a - lift * b for a, b in zip(self.centre, h["centre_of_buoyancy"])]
        return [(weight - lift) * d for d in down] + cross(arm, down)

    def answer(self, state):
        limits = {s["control"]: s["limit"] for s in self.f.get("surfaces", [])}
        delta = state.get("delta", [0.0] * 3)  # (6)
        delta = [
            max(-limits.get(c, x), min(limits.get(c, x), x)) if c in limits else x for c, x in zip(CONTROLS, delta)
        ]
        force, nu = self.force(state["nu"], delta), state["nu"]
        free = [MOTION.index(m) for m in state.get("free", MOTION)]
        if force is None or not self.moves or not set(free) <= set(self.known):
            return {"force": force, "acceleration": None}
        wrench, rest = self.thrust(self.actual(state)), self.afloat(state.get("attitude", [1.0, 0.0, 0.0, 0.0]))
        total = [sum(x) for x in zip(force, wrench, rest, pushed(self.rigid, nu))]
        matrix = [[self.rigid[i][j] + self.added[i][j] for j in free] for i in free]
        if not definite(matrix, range(len(free))):  # (27)
            return {"force": force, "acceleration": None}
        found = dict(zip(free, solved(matrix, [total[i] for i in free])))
        return {"force": force, "acceleration": [found.get(i, 0.0) for i in range(6)]}


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as opened:
        vehicle = Vehicle(json.load(opened))
    json.dump([vehicle.answer(state) for state in json.load(sys.stdin)], sys.stdout)
