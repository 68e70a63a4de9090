"""Changes to the bytes of a file as hands, disks and other programs make them, by a random generator of a seed."""

from __future__ import annotations

import random
import re
import zipfile
from io import BytesIO

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
