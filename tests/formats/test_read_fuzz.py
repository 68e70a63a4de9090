"""Model files spoilt at random, by a seed: every one is read or is one clear error."""

from __future__ import annotations

import random
import re
from pathlib import Path

import pytest

from coeflab.core.errors import CoeflabError
from coeflab.formats.model_files import read_model_file

DATA = Path(__file__).parent / "data"
SAMPLE = DATA.parents[1] / "data" / "parameters_1_3.json"
SOURCES = {
    "lauv.urdf.xacro": 400, "rexrov.urdf": 150, "tethys_like.sdf": 400, "bluerov2_heavy.yml": 60, "bluerov2_heavy.m": 250,
    "torpedo_imperial.m": 150, SAMPLE.name: 300,
}  # fmt: skip
NUMBER = re.compile(rb"(?<![A-Za-z_\d.])[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?(?![A-Za-z_\d])")
IN_ITS_PLACE = (
    "0", "-0.0", "1", "-1", "1e-320", "1e-300", "-1e300", "1e308", "1e999", "nan", "inf", "-inf", "1e18", "1e-18", "9" * 400,
    "9" * 4301, "-1e17", "1e-9", "1e9", "", "x", "[", "0x1", "true", "1e100",
)  # fmt: skip


def spoilt(content: bytes, chance: random.Random) -> bytes:
    """The content with one to five numbers exchanged, pieces dropped or doubled, or bytes changed."""
    for _ in range(chance.choice((1, 1, 1, 2, 5))):
        which, at = chance.random(), chance.randrange(len(content))
        end = at + chance.randrange(1, 200)
        if which < 0.7 and (found := list(NUMBER.finditer(content))):
            m = chance.choice(found)
            content = content[: m.start()] + chance.choice(IN_ITS_PLACE).encode() + content[m.end() :]
        elif which < 0.8:
            content = content[:at] + content[end:]
        elif which < 0.9:
            content = content[:end] + content[at:]
        else:
            content = content[:at] + bytes([chance.randrange(256)]) + content[at + 1 :]
    return content


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", SOURCES)
def test_spoilt_files_are_read_or_refused(name: str, tmp_path: Path) -> None:
    """Before: LinAlgError of inertias and added masses of 1e308, OverflowError of lengths of 1e300."""
    source = SAMPLE if name == SAMPLE.name else DATA / name
    content, chance, path = source.read_bytes(), random.Random(7), tmp_path / name
    outcomes = set()
    for _ in range(SOURCES[name]):
        path.write_bytes(spoilt(content, chance))
        try:
            read_model_file(path)
            outcomes.add("read")
        except CoeflabError as why:
            outcomes.add("refused" if name in str(why) and len(str(why)) < 2000 else f"refused badly: {why}")
    assert outcomes == {"read", "refused"}
