"""Equal bytes whatever the machine and its environment say of threads: real processes, through the library and the command."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from coeflab.core.files import shipped

NAMES = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
THROUGH = {
    "the library": "from coeflab import read_plan, rendered, run\n"
    "from coeflab.core.files import write_all\n"
    "write_all(Path(sys.argv[2]), rendered(run(read_plan(Path(sys.argv[1])))))",
    "the command": "from coeflab.cli import main\nsys.argv[1:] = ['run', sys.argv[1], '--out', sys.argv[2]]\nmain()",
}
PLAN = """
[study]
name = "threads"
[[table]]
campaign = "{campaign}"
fits = ["slope_at_origin", "tied_law"]
[[parameter_file]]
name = "hull"
body = "suboff_bare_hull"
campaigns = ["suboff_roddy_3"]
added_mass = "{hull}"
added_mass_method = "panel"
"""


def made(folder: Path, through: str, threads: int) -> dict[str, bytes]:
    """What a study writes in a process of its own that may take so many threads."""
    folder.mkdir(exist_ok=True)
    plan = folder / "plan.toml"
    campaign, hull = shipped("cfd_data") / "suboff_roddy_3", shipped("geometry") / "suboff_bare_hull"
    plan.write_text(PLAN.format(campaign=campaign.as_posix(), hull=hull.as_posix()))
    out = folder / f"out_{threads}"
    environment = os.environ | dict.fromkeys(NAMES, str(threads))
    start = f"import sys\nfrom pathlib import Path\n{THROUGH[through]}"
    subprocess.run([sys.executable, "-c", start, plan, out], env=environment, check=True, capture_output=True)
    return {p.relative_to(out).as_posix(): p.read_bytes() for p in sorted(out.rglob("*")) if p.is_file()}


@pytest.mark.slow
@pytest.mark.parametrize("through", THROUGH)
def test_a_study_with_panel_added_mass_does_not_depend_on_threads(tmp_path: Path, through: str) -> None:
    alone, two = made(tmp_path, through, 1), made(tmp_path, through, 2)
    assert "hull.parameters.json" in alone
    assert [name for name in alone.keys() | two.keys() if alone.get(name) != two.get(name)] == []


def test_the_setting_from_before_holds_again_afterwards() -> None:
    start = (
        "import numpy, scipy.linalg\nfrom threadpoolctl import threadpool_info as told\n"
        "from coeflab.core.machine import one_thread\n"
        "def threads(): return [t['num_threads'] for t in told() if t['user_api'] == 'blas']\n"
        "before = threads()\nwith one_thread(): inside = threads()\n"
        "print(set(inside), threads() == before, set(before))"
    )
    environment = os.environ | dict.fromkeys(NAMES, "2")
    said = subprocess.run([sys.executable, "-c", start], env=environment, check=True, capture_output=True, text=True)
    assert said.stdout.split() == ["{1}", "True", "{2}" if (os.cpu_count() or 1) > 1 else "{1}"]


def test_a_decorated_function_keeps_its_name_and_gives_its_value() -> None:
    from coeflab.core.machine import one_thread

    @one_thread()
    def seven() -> int:
        return 7

    assert (seven.__name__, seven()) == ("seven", 7)
