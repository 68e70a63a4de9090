"""M and bias of an arm: generated C beside Pinocchio, the compiled and the plain numeric route.

Usage: python arm_equations.py [EIGEN]
EIGEN is a folder with Eigen's headers (pip install cmeel-eigen --target DIR: DIR/cmeel.prefix/include/eigen3). With it Pinocchio
is timed in C++, both built by the same compiler with -O2; without it, through its Python binding, whose calls cost more than
the work. The arm is the shipped PUMA without water, which Pinocchio does not know, then with it. Every figure is the best of
five runs.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from coeflab.arm import compiled, kane  # noqa: E402
from coeflab.arm.arm_file import read_chain  # noqa: E402
from coeflab.arm.chain import Chain, Joint  # noqa: E402
from coeflab.arm.closed_form import derive  # noqa: E402
from coeflab.arm.languages import Origin, written  # noqa: E402
from coeflab.arm.tape import ClosedForm  # noqa: E402
from coeflab.core.files import shipped  # noqa: E402

REPEATS, CALLS = 5, 1_000_000
C_LOOP = """
#define _POSIX_C_SOURCE 199309L
#include <stdio.h>
#include <time.h>
#include "arm.h"
int main(void)
{{
    double q[{n}], s[{size}], down[3] = {{0.1, 0.2, 0.97}}, current[3] = {{0}}, acceleration[3] = {{0}};
    static double M[{size}][{size}], f[{size}];
    double sum = 0.0, best = 1e9;
    int i, k, r;
    for (i = 0; i < {n}; i++) q[i] = 0.3 - 0.4*i;
    for (i = 0; i < {size}; i++) s[i] = 0.5 - 0.1*i;
    for (r = 0; r < {repeats}; r++) {{
        struct timespec a, b;
        clock_gettime(CLOCK_MONOTONIC, &a);
        for (k = 0; k < {calls}; k++) {{
            q[0] = 1e-6*k;
            {call}
            sum += M[{last}][{last}] + f[{last}];
        }}
        clock_gettime(CLOCK_MONOTONIC, &b);
        double taken = (b.tv_sec - a.tv_sec) + 1e-9*(b.tv_nsec - a.tv_nsec);
        if (taken < best) best = taken;
    }}
    printf("%.9g %g\\n", best / {calls}, sum);
    return 0;
}}
"""
SEPARATE = "arm_mass_matrix(q, M); arm_bias(q, s, current, acceleration, f);"
TOGETHER = "arm_equations(q, s, down, current, acceleration, M, f);"
CPP_LOOP = """
#include <pinocchio/multibody.hpp>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>
#include <chrono>
#include <cstdio>
using namespace pinocchio;
int main()
{
    Model model;
    Eigen::Matrix3d r, i;
    Eigen::Vector3d p;
    JointIndex last = 0;
BUILT
    Data data(model);
    Eigen::VectorXd q = Eigen::VectorXd::Zero(model.nq), v = Eigen::VectorXd::LinSpaced(model.nv, 0.5, -0.3);
    q[6] = 1.0;
    double sum = 0.0, best = 1e9;
    for (int k = 0; k < REPEATS; k++) {
        auto a = std::chrono::steady_clock::now();
        for (int c = 0; c < CALLS; c++) {
            q[7] = 1e-6*c;
            crba(model, data, q);
            nonLinearEffects(model, data, q, v);
            sum += data.M(0, model.nv - 1) + data.nle[model.nv - 1];
        }
        double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - a).count();
        if (taken < best) best = taken;
    }
    std::printf("%.9g %g\\n", best / CALLS, sum);
}
"""


def best(work: Callable[[], object], calls: int) -> float:
    """Seconds a call."""
    work()
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        for _ in range(calls):
            work()
        times.append(time.perf_counter() - start)
    return min(times) / calls


def in_c(form: ClosedForm, call: str, folder: Path) -> float:
    """Seconds a call, timed in C."""
    for name, content in written(form, "c", Origin("body.toml", "0" * 64)).items():
        (folder / name).write_bytes(content)
    size = form.size
    text = C_LOOP.format(n=len(form.links), size=size, last=size - 1, repeats=REPEATS, calls=CALLS, call=call)
    (folder / "loop.c").write_text(text)
    subprocess.run(["cc", "-std=c99", "-O2", "-o", "loop", "loop.c", "arm.c", "-lm"], cwd=folder, check=True)
    return float(subprocess.run(["./loop"], cwd=folder, check=True, capture_output=True, text=True).stdout.split()[0])


def placed(turn: np.ndarray, shift: np.ndarray, mass: float, centre: np.ndarray, inertia: np.ndarray, kind: str) -> str:
    """A joint and its body in C++."""
    rows = ["r", "i"]
    text = "".join(
        f"    {name} << {', '.join(repr(float(v)) for v in np.ravel(m))};\n" for name, m in zip(rows, (turn, inertia))
    )
    text += f"    p << {', '.join(repr(float(v)) for v in shift)};\n"
    text += f"    last = model.addJoint(last, {kind}(), SE3(r, p), std::to_string(model.njoints));\n"
    text += f"    p << {', '.join(repr(float(v)) for v in centre)};\n"
    return text + f"    model.appendBodyToJoint(last, Inertia({mass!r}, p, i), SE3::Identity());\n"


def pinocchio_in_cpp(chain: Chain, eigen: Path, folder: Path) -> float:
    """Seconds of crba and nonLinearEffects, timed in C++. Joint frames as in `closed_form`: fixed in the link, z along the joint."""
    import pinocchio

    prefix = next(p for p in Path(pinocchio.__file__).parents if p.name == "cmeel.prefix")
    base = chain.base
    text = placed(np.eye(3), np.zeros(3), base.mass, np.zeros(3), base.inertia, "JointModelFreeFlyer")
    turn, shift = np.array(chain.mount), np.array(chain.attachment)
    for link in chain.links:
        j: Joint = link.joint
        c, s = np.cos(j.alpha), np.sin(j.alpha)
        own = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
        centre = own @ link.centre_of_mass + [j.a, 0, 0]
        shift = shift + turn @ [0, 0, j.d]
        kind = "JointModelRZ" if j.turns else "JointModelPZ"
        text += placed(turn, shift, link.mass, centre, own @ link.inertia @ own.T, kind)
        turn, shift = own, np.array([j.a, 0, 0])
    source = CPP_LOOP.replace("BUILT", text).replace("REPEATS", str(REPEATS)).replace("CALLS", str(CALLS))
    (folder / "loop.cpp").write_text(source)
    include = [f"-I{prefix}/include", f"-I{eigen}"]
    link_to = [f"-L{prefix}/lib", f"-Wl,-rpath,{prefix}/lib", "-lpinocchio_default"]
    boost = [
        "-DBOOST_MPL_LIMIT_LIST_SIZE=40",
        "-DBOOST_MPL_LIMIT_VECTOR_SIZE=40",
        "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    ]
    build = ["c++", "-std=c++17", "-O2", "-DNDEBUG", "-DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION", *boost, *include]
    subprocess.run([*build, "-o", "theirs", "loop.cpp", *link_to], cwd=folder, check=True)
    return float(subprocess.run(["./theirs"], cwd=folder, check=True, capture_output=True, text=True).stdout.split()[0])


def pinocchio_in_python(chain: Chain) -> float:
    """Seconds of crba and nonLinearEffects, called from Python."""
    import pinocchio as pin

    from tests.arm.chains import pinocchio_model

    model = pinocchio_model(chain)
    data, q, v = model.createData(), pin.neutral(model), np.linspace(0.5, -0.3, model.nv)

    def work() -> None:
        pin.crba(model, data, q)
        pin.nonLinearEffects(model, data, q, v)

    return best(work, 20_000)


def numeric(chain: Chain) -> tuple[float, float]:
    """Seconds of M and bias, by numba and by numpy, called from Python."""
    q, s, still = np.array([0.3, -0.1, -0.5]), 0.5 - 0.1 * np.arange(9), np.zeros(6)
    frame, bodies, _ = compiled.packed(chain)

    def by_numba() -> None:
        compiled.mass_matrix(frame, bodies, q)
        compiled.bias(frame, bodies, q, s, still)

    def by_numpy() -> None:
        kane.mass_matrix(chain, q)
        kane.bias(chain, q, s)

    return best(by_numba, 2_000), best(by_numpy, 100)


def main() -> None:
    wet = replace(read_chain(shipped("geometry") / "urv_puma"), name="arm")
    links = tuple(replace(one, added_mass=np.zeros((6, 6)), strips=(), volume=0.0) for one in wet.links)
    hull = replace(wet.base, added_mass=np.zeros((6, 6)), drag_area=np.zeros(3), volume=0.0)
    dry = replace(wet, base=hull, links=links)
    eigen = Path(sys.argv[1]) if len(sys.argv) > 1 else None
    for name, chain in (("without water", dry), ("with water", wet)):
        start = time.perf_counter()
        form = derive(chain)
        print(f"PUMA of 3 links on a vehicle, {name}; derived in {time.perf_counter() - start:.1f} s")
        with tempfile.TemporaryDirectory() as folder:
            c = in_c(form, SEPARATE, Path(folder))
            all_c = in_c(form, TOGETHER, Path(folder))
        by_numba, by_numpy = numeric(chain)
        rows = [("M and bias, generated C", c), ("M and all forces together, generated C", all_c)]
        rows += [("M and bias, numba, called from Python", by_numba), ("M and bias, numpy", by_numpy)]
        if chain is dry:
            rows.append(("crba and nonLinearEffects, Pinocchio called from Python", pinocchio_in_python(chain)))
            if eigen:
                with tempfile.TemporaryDirectory() as folder:
                    theirs = pinocchio_in_cpp(chain, eigen, Path(folder))
                rows.append(("crba and nonLinearEffects, Pinocchio in C++", theirs))
        for label, taken in rows:
            print(f"  {label:56s} {1e6 * taken:10.3f} us   {taken / c:8.1f}")


if __name__ == "__main__":
    main()
