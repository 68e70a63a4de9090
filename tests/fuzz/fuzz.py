"""All parsers on spoilt inputs, by a seed: each is read or refused by one clear error, soon and in little memory.

python -m tests.fuzz.fuzz [--count 1000000] [--first 0] [--parser table]

takes a sample of a parser, spoils it and reads it. Anything but the errors that the parser may raise comes out as it is, and what made it is
kept in the folder of temporary files: mend the fault, and put that input into ``tests/fuzz/cases/PARSER``, where every run tries it.
"""

from __future__ import annotations

import argparse
import random
import resource
import shutil
import tempfile
import time
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from coeflab.core.errors import CoeflabError
from tests.conftest import peak_kilobytes
from tests.fuzz.parsers import Parser, parsers, require_short
from tests.fuzz.spoiling import repacked, spoilt

CASES = Path(__file__).parent / "cases"
SLOWEST_S = 2.0


@dataclass(slots=True)
class Tally:
    """What came of the inputs of one parser."""

    parser: str
    inputs: int = 0
    refused: int = 0
    read: int = 0
    slowest_ms: float = 0.0
    slowest_seed: int = 0
    seconds: float = 0.0

    @property
    def line(self) -> str:
        return f"{self.parser:12} {self.inputs:8} {self.refused:8} {self.read:8} {self.slowest_ms:9.0f} {self.slowest_seed:8} {self.seconds:8.0f}"


HEADER = f"{'parser':12} {'inputs':>8} {'refused':>8} {'read':>8} {'worst ms':>9} {'seed':>8} {'seconds':>8}"


def is_read(parser: Parser, given: Path | str) -> bool:
    """Whether an input is read; False where it is refused as it should."""
    try:
        parser.read(given)
    except CoeflabError as why:
        require_short(why)
        return False
    except parser.also:
        return False
    return True


@contextmanager
def copies(parser: Parser) -> Iterator[list[tuple[Path, list[Path]]]]:
    """A copy of every sample, in memory where possible, and the files of each."""
    memory = Path("/dev/shm")
    with tempfile.TemporaryDirectory(dir=memory if memory.is_dir() else None) as folder:
        out = []
        for number, sample in enumerate(parser.samples):
            copy = Path(folder) / str(number) / sample.name
            copy.parent.mkdir()
            if sample.is_dir():
                shutil.copytree(sample, copy, symlinks=True)
            elif parser.beside:
                shutil.copytree(sample.parent, copy.parent, dirs_exist_ok=True)
            else:
                shutil.copyfile(sample, copy)
            parts = (
                sorted(p for p in copy.rglob("*") if p.is_file() and not p.is_symlink()) if copy.is_dir() else [copy]
            )
            out += [(copy, parts)] if parts else []
        yield out


def fuzz(name: str, count: int, first: int = 0) -> Tally:
    """Spoil the samples of a parser; the seeds are first, first + 1, ..."""
    parser, tally = parsers()[name], Tally(name)
    with copies(parser) as samples, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        whole = {part: part.read_bytes() for _, parts in samples for part in parts}
        for seed in range(first, first + count):
            chance = random.Random(seed)
            given: Path | str
            if parser.texts:
                content = spoilt(chance.choice(parser.texts).encode(), chance)
                given, part = content.decode("utf-8", "replace"), None
            else:
                given, parts = chance.choice(samples)
                part = chance.choice(parts)
                packed = whole[part].startswith(b"PK") and chance.random() < 0.7
                content = (repacked if packed else spoilt)(whole[part], chance)
                part.write_bytes(content)
            start = time.process_time()  # of this process: others may have the machine
            try:
                read = is_read(parser, given)
            except BaseException as why:
                kept = Path(tempfile.gettempdir()) / f"spoilt_{name}_{seed}"
                kept.write_bytes(content)
                why.add_note(f"parser {name}, seed {seed}, {part.name if part else 'text'}; kept as {kept}")
                raise
            ms = 1000.0 * (time.process_time() - start)
            if part is not None:
                part.write_bytes(whole[part])
            tally.inputs, tally.read, tally.refused = tally.inputs + 1, tally.read + read, tally.refused + (not read)
            tally.seconds += ms / 1000.0
            if ms > tally.slowest_ms:
                tally.slowest_ms, tally.slowest_seed = ms, seed
    return tally


def case_is_refused(path: Path) -> bool:
    """Whether a kept case, ``PARSER/NAME`` or, of a folder, ``PARSER/NAME__FILE``, is read or refused as it should; raises what else comes."""
    parser = parsers()[path.parent.name]
    if parser.texts:
        return not is_read(parser, path.read_bytes().decode("utf-8", "replace"))
    name = path.name.partition("__")[2] or path.name
    with copies(parser) as samples:
        sample, part = next((s, p) for s, parts in samples for p in parts if p.name == name)
        part.write_bytes(path.read_bytes())
        return not is_read(parser, sample)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=1_000_000, help="of all parsers together")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--parser", action="append", choices=list(parsers()))
    given = parser.parse_args()
    known = {name: one.share for name, one in parsers().items() if not given.parser or name in given.parser}
    print(HEADER)
    total = faults = 0
    for name, share in known.items():
        try:
            tally = fuzz(name, round(given.count * share / sum(known.values())), given.first)
        except Exception as why:  # the other parsers are tried all the same
            faults += 1
            print("".join(traceback.format_exception(why)), flush=True)
            continue
        total += tally.inputs
        print(tally.line, f"{peak_kilobytes() / 1024:6.0f} MB", flush=True)
    print(
        f"{total} inputs; peak {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0:.0f} MB; {faults} parsers with a fault"
    )
    raise SystemExit(1 if faults else 0)


if __name__ == "__main__":
    main()
