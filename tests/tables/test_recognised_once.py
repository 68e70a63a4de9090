"""Every sample of every importer is recognised by its own importer and by no other."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from coeflab.tables.importers import IMPORTERS
from coeflab.tables.monitor_files import decoded, head, kind_of, lines_of

SAMPLES = Path(__file__).parent / "samples"
READERS = [n for n in IMPORTERS.names() if (i := IMPORTERS.load(n)).raw is not None or i.run is not None]
ENTRIES = sorted(p for n in READERS if (SAMPLES / n).is_dir() for p in (SAMPLES / n).iterdir() if p.suffix != ".md")


def test_there_are_samples_of_the_solvers() -> None:
    assert {"starccm", "fluent", "su2"} <= {p.parent.name for p in ENTRIES}


@pytest.mark.parametrize("path", ENTRIES, ids=lambda p: f"{p.parent.name}/{p.name}")
def test_one_importer_knows_a_sample(path: Path) -> None:
    assert [name for name in READERS if IMPORTERS.load(name).recognises(path)] == [path.parent.name]


def test_one_writer_at_most_claims_a_file() -> None:
    writers = {n: w for n in READERS if (w := IMPORTERS.load(n).wrote)}
    found = {}
    for path in (f for e in ENTRIES for f in (e.rglob("*") if e.is_dir() else [e]) if f.is_file()):
        claims = [n for n, wrote in writers.items() if wrote(lines_of(decoded(head(path))[0]))]
        assert len(claims) <= 1
        assert kind_of(head(path)) == "".join(claims)
        found |= dict.fromkeys(claims, path)
    assert set(found) == set(writers)


def test_a_folder_of_several_solvers_is_nobodys(tmp_path: Path) -> None:
    solvers = [IMPORTERS.load(n) for n in ("starccm", "fluent", "su2")]
    shutil.copy(SAMPLES / "su2/v8_drift/history.csv", tmp_path)
    assert [s.recognises(tmp_path) for s in solvers] == [False, False, True]
    shutil.copy(SAMPLES / "starccm/forces.csv", tmp_path)
    assert not any(s.recognises(tmp_path) for s in solvers)
    (tmp_path / "forces.csv").unlink()
    (tmp_path / "constant").mkdir()  # a case of OpenFOAM
    assert not any(s.recognises(tmp_path) for s in solvers)


@pytest.mark.parametrize("name", READERS)
def test_what_cannot_be_read_is_not_recognised(name: str, tmp_path: Path) -> None:
    (tmp_path / "empty.csv").touch()
    (tmp_path / "loop").symlink_to(tmp_path / "loop")
    (tmp_path / "binary.dat").write_bytes(bytes(range(256)) * 64)
    recognises = IMPORTERS.load(name).recognises
    assert not any(recognises(tmp_path / f) for f in ("empty.csv", "loop", "binary.dat", "missing.out"))
