from __future__ import annotations

from pathlib import Path

import pytest

from coeflab.core.errors import InputError
from coeflab.core.text.toml import read_toml


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"a = 1\nb = = 2\n", "at line 2, column 5"),
        (b"a = 1\na = 2\n", "a TOML error"),
        (b"a = " + b"[" * 100_000, "valid TOML"),
        (b"a = 1\nb = '\xff'\n", "line 2: found the byte 0xff; expected UTF-8 text"),
        (b"", "found an empty file"),
        (b"a = '\0'", "a TOML error"),
    ],
)
def test_no_toml(tmp_path: Path, content: bytes, said: str) -> None:
    (tmp_path / "f.toml").write_bytes(content)
    with pytest.raises(InputError) as caught:
        read_toml(tmp_path / "f.toml")
    assert said in str(caught.value)


def test_a_bom_is_harmless(tmp_path: Path) -> None:
    (tmp_path / "f.toml").write_bytes(b"\xef\xbb\xbfa = 1\n")
    assert read_toml(tmp_path / "f.toml").content == {"a": 1}
