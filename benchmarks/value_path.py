"""The path of one value: files that run, and files whose functions return Yv', from the CSV cell to HTML and xdyn.

python benchmarks/value_path.py [--list]     --list names the files that return the value

The study is that of ``coeflab validate suboff``; the value is Yv' of Roddy's configuration 2, known from a first run.
"""

from __future__ import annotations

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import sys
from pathlib import Path
from types import FrameType
from typing import Any

import coeflab
from coeflab.report.rendered import rendered

PACKAGE = str(Path(coeflab.__file__).parent)
NAME = "suboff_fully_appended"


def main() -> None:
    """Run twice, the second time under a profiler."""
    value = coeflab.run(coeflab.validation("suboff")).parameter_files[NAME].coefficient("Yv").value
    run: set[str] = set()
    returning: set[str] = set()

    def watch(frame: FrameType, event: str, returned: Any) -> None:
        file = frame.f_code.co_filename
        if event != "return" or not file.startswith(PACKAGE):
            return
        run.add(file)
        if isinstance(returned, float) and abs(returned - value) <= 1e-12 * abs(value):
            returning.add(file)

    sys.setprofile(watch)
    study = coeflab.run(coeflab.validation("suboff"))
    files = rendered(study, ("html",))
    sys.setprofile(None)
    assert any(name.endswith(".yml") for name in files)
    sys.stdout.write(f"files that run                  {len(run)}\nfiles that return the value     {len(returning)}\n")
    if "--list" in sys.argv:
        for file in sorted(returning):
            sys.stdout.write(f"{Path(file).relative_to(PACKAGE)}\n")


if __name__ == "__main__":
    main()
