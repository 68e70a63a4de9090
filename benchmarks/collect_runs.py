"""A folder of 5,000 OpenFOAM cases as one table, against a plain loop of `csv.reader` and `float` over the same files.

The loop reads force.dat and moment.dat of every case and averages the last half of their totals, no more. Ours also walks the
folder, reads dictionaries, joins conditions, finds plateaus and errors of six components and of pressure and viscous shares.
Runs are synthetic: `python benchmarks/collect_runs.py [CASES] [ROWS]`.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import csv
import resource
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from coeflab.core.machine import cores
from coeflab.tables.collect import collect_groups

HEAD = "# {what}\n# CofR          : (2.0 0.0 0.0)\n#\n# Time\t(total_x total_y total_z)\t(pressure_x pressure_y pressure_z)\t(viscous_x viscous_y viscous_z)\n"
FOAM = "FoamFile\n{{\n    version 2.0;\n    format ascii;\n    class {kind};\n    object {name};\n}}\n"
CONTROL = """application simpleFoam;
startTime 0;
endTime {rows};
functions
{{
    forces
    {{
        type forces;
        libs ("libforces.so");
        patches (hull);
        rho rhoInf;
        rhoInf 998;
        CofR (2 0 0);
    }}
}}
"""
FLOW = """dimensions [0 1 -1 0 0 0 0];
internalField uniform ({u:.9g} {v:.9g} 0);
boundaryField
{{
    inlet
    {{
        type fixedValue;
        value uniform ({u:.9g} {v:.9g} 0);
    }}
    hull
    {{
        type noSlip;
    }}
}}
"""


def written(root: Path, cases: int, rows: int) -> None:
    """Drift sweeps of a synthetic hull, one case a folder."""
    rng = np.random.default_rng(1)
    settle = np.exp(-np.arange(rows) / (rows / 20.0))[:, None]
    for i in range(cases):
        beta = np.radians(-20.0 + 40.0 * i / cases)
        case = root / f"set{i // 100:03d}" / f"b{i:05d}"
        for folder in ("0", "constant", "system", "postProcessing/forces/0"):
            (case / folder).mkdir(parents=True)
        head = FOAM.format(kind="dictionary", name="controlDict")
        (case / "system/controlDict").write_text(head + CONTROL.format(rows=rows))
        (case / "system/fvSchemes").write_text(
            FOAM.format(kind="dictionary", name="fvSchemes") + "ddtSchemes\n{\n    default steadyState;\n}\n"
        )
        flow = FLOW.format(u=2.0 * np.cos(beta), v=2.0 * np.sin(beta))
        (case / "0/U").write_text(FOAM.format(kind="volVectorField", name="U") + flow)
        fluid = "transportModel Newtonian;\nnu 1e-06;\n"
        (case / "constant/transportProperties").write_text(
            FOAM.format(kind="dictionary", name="transportProperties") + fluid
        )
        for what, mean in (("force", [40.0, 500.0 * beta, 0.0]), ("moment", [0.0, 0.0, 1500.0 * beta])):
            viscous = 0.2 * np.array(mean) + 0.01 * rng.normal(size=(rows, 3))
            pressure = 0.8 * np.array(mean) + 0.05 * rng.normal(size=(rows, 3)) + settle
            lines = [
                f"{k + 1}\t" + "\t".join("({:.8e} {:.8e} {:.8e})".format(*v) for v in (p + w, p, w))
                for k, (p, w) in enumerate(zip(pressure, viscous, strict=True))
            ]
            file = case / f"postProcessing/forces/0/{what}.dat"
            file.write_text(HEAD.format(what=what.capitalize()) + "\n".join(lines) + "\n")


def plain(root: Path) -> list[list[float]]:
    """Means of the last half of the totals, by csv.reader and float."""
    out = []
    for case in sorted(root.glob("set*/b*")):
        means: list[float] = []
        for what in ("force", "moment"):
            with (case / f"postProcessing/forces/0/{what}.dat").open() as stream:
                numbers = [
                    [float(c.strip("()")) for cell in row for c in cell.split()]
                    for row in csv.reader(stream, delimiter="\t")
                    if not row[0].startswith("#")
                ]
            half = numbers[len(numbers) // 2 :]
            means += [sum(row[k] for row in half) / len(half) for k in (1, 2, 3)]
        out.append(means)
    return out


def main() -> None:
    cases, rows = (int(sys.argv[k]) if len(sys.argv) > k else d for k, d in ((1, 5000), (2, 200)))
    with tempfile.TemporaryDirectory() as folder:
        root, state = Path(folder) / "runs", Path(folder) / "state.jsonl"
        written(root, cases, rows)
        old = time.time() - 3600.0
        for path in [root, *root.rglob("*")]:
            os.utime(path, (old, old))
        began = time.perf_counter()
        loop = plain(root)
        theirs = time.perf_counter() - began
        times = {}
        for name, workers, kept in (
            ("one process", 1, None),
            (f"{cores()} processes", cores(), state),
            ("continued", 1, state),
        ):
            lines: list[str] = []
            began = time.perf_counter()
            found = collect_groups(root, "openfoam", workers=workers, state=kept, progress=lines.append)[0]
            times[name] = time.perf_counter() - began, found.again, len(lines)
        y = found.table.meaning("Y")
        assert y is not None
        np.testing.assert_allclose(y.values, [m[1] for m in loop], rtol=0.02, atol=0.1)
        counts = ", ".join(f"{n} {s}" for s, n in found.counts.items())
    print(f"{cases:,} cases of {rows} rows: {counts}")
    print(f"plain loop        {theirs:8.2f} s")
    for name, (seconds, again, said) in times.items():
        print(f"{name:17} {seconds:8.2f} s   ratio {seconds / theirs:5.2f}   {again:,} read, {said} lines of progress")
    print(f"largest memory of this process {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:.0f} MB, of one "
          f"of its processes {resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024:.0f} MB")  # fmt: skip


if __name__ == "__main__":
    main()
