"""Files of other people spoilt at random, by a seed: every one is read or refused by one clear error, soon and in little memory.

python tests/tables/mutated_inputs.py [--count 100000] [--importer table]

takes every sample under tests/tables/samples/IMPORTER (a file, or a folder that is a case, whose files are spoilt one at a
time), spoils it and hands it to `recognises` and to `raw` or `run`. Anything but an InputError comes out as it is.
"""

from __future__ import annotations

import argparse
import random
import re
import resource
import shutil
import tempfile
import time
import warnings
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

from coeflab.core.errors import InputError
from coeflab.tables.importers import IMPORTERS

SAMPLES = Path(__file__).parent / "samples"
SLOWEST_S = 2.0
LONGEST_MESSAGE = 4000
NUMBER = re.compile(rb"(?<![A-Za-z_\d.])[-+]?\d+(?:[.,]\d*)?(?:[eEdD][-+]?\d+)?(?![A-Za-z_\d])")
IN_ITS_PLACE = (
    b"nan", b"inf", b"-inf", b"1e999", b"-1e308", b"1e-320", b"0", b"-0.0", b"", b"-", b"1,234", b"1.234", b"1 234", b"1_0",
    b"0x1p3", b"9" * 400, b"9" * 5000, b"1." + b"3" * 3000, b"#DIV/0!", b"--1", b"1e", b"x", b'"', b"(", b"((((", b"1d3",
    "−1".encode(), "１".encode(), b"\xff", b"1e18", b"2000000000", b"-1",
)  # fmt: skip
BLOCKS = (
    b"\n", b"\r", b"\r\n", b"\n" * 50, b"\t", b";", b",", b"|", b" ", b'"', b"#", b"{", b"}", b"(", b")", b"\\", b"//", b"/*",
    b"\0", b"\xff\xfe", b"\xef\xbb\xbf", b"=", b"[", b"$x", b"#include \"x\"\n", b"a" * 5000, b"," * 3000, b"1," * 3000,
)  # fmt: skip
DELIMITERS = (b",", b";", b"\t", b"|", b" ")
ENDS = (b"\n", b"\r\n", b"\r", b"\n\n")


def spoilt(content: bytes, chance: random.Random) -> bytes:
    """The content with one to five changes: bytes, pieces, numbers, delimiters, line ends, encoding, or cut."""
    for _ in range(chance.choice((1, 1, 1, 2, 3, 5))):
        content = _changed(content, chance)
    return content


def _changed(content: bytes, chance: random.Random) -> bytes:
    at = chance.randrange(len(content) + 1)
    end = at + chance.choice((1, 3, 20, 200))
    kind = chance.randrange(12)
    if kind <= 3 and (found := list(NUMBER.finditer(content[:20_000]))):
        m = chance.choice(found)
        return content[: m.start()] + chance.choice(IN_ITS_PLACE) + content[m.end() :]
    if kind == 4:
        return content[:at] + content[end:]
    if kind == 5:
        return content[:end] + content[at:]
    if kind == 6:
        return content[:at]
    if kind == 7:
        return content[:at] + chance.choice(BLOCKS) + content[at:]
    if kind == 8:
        return content.replace(chance.choice(DELIMITERS), chance.choice(DELIMITERS), chance.choice((1, 5, -1)))
    if kind == 9:
        return content.replace(b"\n", chance.choice(ENDS), chance.choice((1, 3, -1)))
    if kind == 10:
        text = content.decode("latin-1")
        return text.encode(chance.choice(("utf-16", "utf-8", "utf-16-le", "utf-8-sig")))
    flipped = bytearray(content)
    for _ in range(min(chance.choice((1, 1, 4, 30)), len(content))):
        flipped[chance.randrange(len(content))] = chance.randrange(256)
    return bytes(flipped)


def repacked(content: bytes, chance: random.Random) -> bytes:
    """A workbook with one of its parts spoilt inside, so that the change reaches the reader of XML."""
    out = BytesIO()
    with zipfile.ZipFile(BytesIO(content)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
        names = old.namelist()
        sheets = [n for n in names if "sheet" in n.lower() or n == "content.xml"] or names
        wanted = chance.choice((*sheets, *sheets, *names))
        for name in names:
            new.writestr(name, spoilt(old.read(name), chance) if name == wanted else old.read(name))
    return out.getvalue()


@dataclass(slots=True)
class Tally:
    """What came of the inputs of one importer."""

    importer: str
    inputs: int = 0
    errors: int = 0
    read: int = 0
    slowest_ms: float = 0.0
    slowest_seed: int = 0

    @property
    def line(self) -> str:
        return f"{self.importer:12} {self.inputs:8} {self.errors:12} {self.read:8} {self.slowest_ms:9.0f}"


HEADER = f"{'importer':12} {'inputs':>8} {'InputErrors':>12} {'read':>8} {'worst ms':>9}"


def of_foreign_files() -> list[str]:
    """Importers that bring whole tables or runs."""
    return [n for n in IMPORTERS.names() if IMPORTERS.load(n).raw or IMPORTERS.load(n).run]


def with_samples() -> list[str]:
    """Those of them that have samples."""
    return [n for n in of_foreign_files() if (SAMPLES / n).is_dir() and any((SAMPLES / n).iterdir())]


def _touch(found: Any) -> None:
    """Use what was read, so that something broken inside shows."""
    table = getattr(found, "history", found)
    assert all(len(c.values) == len(table) for c in table.columns)
    assert all(not c.texts or len(c.texts) == len(table) for c in table.columns)
    assert len(table.lines) in (0, len(table))


def attempt(importer: Any, path: Path) -> bool:
    """Whether a spoilt input is read; False where it is refused by an InputError of bearable length."""
    importer.recognises(path)
    read = False
    for reader in filter(None, (importer.raw, importer.run)):
        try:
            _touch(reader(path, {}))
            read = True
        except InputError as why:
            if len(str(why)) >= LONGEST_MESSAGE:
                raise ValueError(f"a message of {len(str(why))} letters") from why
    return read


def _parts(sample: Path) -> list[Path]:
    return [sample] if sample.is_file() else sorted(p for p in sample.rglob("*") if p.is_file() and not p.is_symlink())


@contextmanager
def copies(name: str) -> Iterator[tuple[Path, list[tuple[Path, list[Path]]]]]:
    """A folder in memory where possible, with a copy of every sample and the files of each."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        out = []
        for sample in sorted((SAMPLES / name).iterdir()):
            copy = Path(folder) / sample.name
            if sample.is_dir():
                shutil.copytree(sample, copy, symlinks=True)
            else:
                shutil.copyfile(sample, copy)
            if parts := _parts(copy):
                out.append((copy, parts))
        yield Path(folder), out


def fuzz(name: str, count: int, first: int = 0) -> Tally:
    """Spoil the samples of an importer; the seeds are first, first + 1, ..."""
    importer, tally = IMPORTERS.load(name), Tally(name)
    with copies(name) as (_, samples), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole = {part: part.read_bytes() for _, parts in samples for part in parts}
        for seed in range(first, first + count):
            chance = random.Random(seed)
            sample, parts = chance.choice(samples)
            part = chance.choice(parts)
            packed = whole[part].startswith(b"PK") and chance.random() < 0.7
            part.write_bytes((repacked if packed else spoilt)(whole[part], chance))
            start = time.process_time()  # of this process: others may have the machine
            try:
                read = attempt(importer, sample)
            except BaseException as why:
                kept = Path(tempfile.gettempdir()) / f"spoilt_{name}_{seed}"
                kept.write_bytes(part.read_bytes())
                why.add_note(f"importer {name}, seed {seed}, {part.name}; kept as {kept}")
                raise
            ms = 1000.0 * (time.process_time() - start)
            part.write_bytes(whole[part])
            tally.inputs, tally.read, tally.errors = tally.inputs + 1, tally.read + read, tally.errors + (not read)
            if ms > tally.slowest_ms:
                tally.slowest_ms, tally.slowest_seed = ms, seed
    return tally


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=100_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--importer", action="append", choices=with_samples())
    given = parser.parse_args()
    print(HEADER)
    for name in given.importer or with_samples():
        tally = fuzz(name, given.count, given.first)
        print(tally.line, f"(seed {tally.slowest_seed})", flush=True)
    print(f"largest resident size {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0:.0f} MB")


if __name__ == "__main__":
    main()
