"""Time of one call of the generated C, in C: ``python benchmarks/c_speed.py [PARAMS]``; REMUS 100 unless a file is named."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import coeflab as cf
from coeflab.formats.c_program import program as c

CALLS = 2_000_000
MAIN = """
#include "NAME.h"
#include <stdio.h>
#include <time.h>
int main(void)
{
    double nu[6] = {1.5, 0.1, 0.05, 0.0, 0.02, 0.1}, none[6] = {0}, delta[3] = {0.1, 0.0, 0.0}, attitude[4] = {1, 0, 0, 0}, out[6], sum = 0.0;
    const clock_t start = clock();
    long k;
    for (k = 0; k < CALLS; k++) {
        nu[1] = 1e-7 * (double) k;
        NAME_acceleration(nu, attitude, delta, none, out);
        sum += out[1];
    }
    printf("%.3f us a call of forces and accelerations (%g)\\n", 1e6 * (double) (clock() - start) / CLOCKS_PER_SEC / CALLS, sum);
    return 0;
}
"""


def main() -> None:
    file = cf.read_vehicle(sys.argv[1] if len(sys.argv) > 1 else "remus100").file
    name = c.name_of(file)
    with tempfile.TemporaryDirectory() as folder:
        for written, content in c.render(file).items():
            (Path(folder) / written).write_bytes(content)
        (Path(folder) / "speed.c").write_text(
            MAIN.replace("NAME", name).replace("CALLS", f"{CALLS}L"), encoding="utf-8"
        )
        subprocess.run(["gcc", "-std=c99", "-O2", f"{name}.c", "speed.c", "-o", "speed", "-lm"], cwd=folder, check=True)
        print(
            f"{file.name}: {subprocess.run(['./speed'], cwd=folder, capture_output=True, text=True, check=True).stdout.strip()}"
        )


if __name__ == "__main__":
    main()
