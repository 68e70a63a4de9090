from __future__ import annotations

import os
from pathlib import Path

import pytest

from coeflab.core.errors import InputError, OutputError
from coeflab.core.files import located, shipped, typed, write_all, write_atomically
from coeflab.core.provenance import sha256_of


def test_content_and_folders(tmp_path: Path) -> None:
    target = tmp_path / "a" / "b" / "c.txt"
    assert write_atomically(target, b"one")
    assert target.read_bytes() == b"one"
    assert target.stat().st_mode & 0o777 == 0o644
    assert [p.name for p in target.parent.iterdir()] == ["c.txt"]


def test_equal_content_is_left_untouched(tmp_path: Path) -> None:
    target = tmp_path / "c.txt"
    write_atomically(target, b"one")
    os.utime(target, ns=(1, 1))
    inode = target.stat().st_ino
    assert not write_atomically(target, b"one")
    assert (target.stat().st_mtime_ns, target.stat().st_ino) == (1, inode)
    assert write_atomically(target, b"two")
    assert target.stat().st_mtime_ns > 1


@pytest.mark.parametrize("where", ["write", "replace"])
def test_a_failure_leaves_the_old_file_and_no_litter(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, where: str
) -> None:
    target = tmp_path / "c.txt"
    write_atomically(target, b"old")

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(*((Path, "replace") if where == "replace" else (os, "fdopen")), fail)
    with pytest.raises(OutputError, match=r"cannot write .*c\.txt: No space left on device"):
        write_atomically(target, b"new")
    assert target.read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["c.txt"]


def test_several_files_and_folders(tmp_path: Path) -> None:
    assert write_all(tmp_path, {"a.txt": b"a", "below/b.txt": b"b"}) == {"a.txt": True, "below/b.txt": True}
    assert write_all(tmp_path, {"a.txt": b"a", "below/b.txt": b"B"}) == {"a.txt": False, "below/b.txt": True}
    assert (tmp_path / "below" / "b.txt").read_bytes() == b"B"
    assert sorted(p.name for p in tmp_path.rglob("*")) == ["a.txt", "b.txt", "below"]


@pytest.mark.parametrize("how", ["a full disk", "a folder in the way"])
def test_a_failure_at_the_last_of_several_files_leaves_all_old_ones(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, how: str
) -> None:
    write_all(tmp_path, {"a.txt": b"old", "b.txt": b"old"})
    opened = os.fdopen

    def full(*arguments: object, **more: object) -> object:
        if any(tmp_path.glob(".c.txt*")):
            raise OSError(28, "No space left on device")
        return opened(*arguments, **more)  # type: ignore[call-overload]

    if how == "a full disk":
        monkeypatch.setattr(os, "fdopen", full)
    else:
        (tmp_path / "c.txt").mkdir()
    before = sorted(p.name for p in tmp_path.iterdir())
    with pytest.raises(OutputError, match=r"cannot write .*c\.txt"):
        write_all(tmp_path, {"a.txt": b"new", "b.txt": b"new", "c.txt": b"new"})
    assert (tmp_path / "a.txt").read_bytes() == (tmp_path / "b.txt").read_bytes() == b"old"
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_places_that_cannot_be_written(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(OutputError, match="cannot write"):
        write_atomically(tmp_path / "file" / "below" / "c.txt", b"x")
    (tmp_path / "folder").mkdir()
    with pytest.raises(OutputError, match="cannot write"):
        write_atomically(tmp_path / "folder", b"x")
    with pytest.raises(OutputError, match="cannot write"):
        write_atomically(tmp_path / ("n" * 300), b"x")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["file", "folder"]


def test_shipped_data() -> None:
    assert (shipped("cfd_data") / "suboff" / "plan.toml").is_file()
    assert (shipped("geometry") / "suboff" / "body.toml").is_file()
    assert located("suboff_roddy_2", "cfd_data") == shipped("cfd_data") / "suboff_roddy_2"


def test_a_path_beside_the_plan_comes_before_a_shipped_name(tmp_path: Path) -> None:
    (tmp_path / "suboff_roddy_2").mkdir()
    assert located("suboff_roddy_2", "cfd_data", tmp_path) == tmp_path / "suboff_roddy_2"
    assert located(tmp_path, "cfd_data", Path("elsewhere")) == tmp_path


@pytest.mark.parametrize("name", ["nowhere", "../nowhere", "a\0b", "n" * 5000, ""])
def test_paths_to_nothing(tmp_path: Path, name: str) -> None:
    if not name:
        assert located(name, "cfd_data", tmp_path) == tmp_path
        return
    with pytest.raises(InputError, match=r"no file or folder|no usable path"):
        located(name, "cfd_data", tmp_path)


@pytest.mark.parametrize("name", ["n" * 5000, "~nobody-of-this-name/x"])
def test_text_that_no_path_can_be(name: str) -> None:
    with pytest.raises(InputError, match="no usable path") as why:
        typed(name)
    assert len(str(why.value)) < 300
    assert typed("nowhere") == Path("nowhere")


def test_a_long_name_is_cut_in_the_middle() -> None:
    told = str(InputError("no such file", "a file", file="a" + "n" * 5000 + "z"))
    assert len(told) < 500
    assert told.startswith("annn")
    assert "nnnz: found" in told


def test_sha256(tmp_path: Path) -> None:
    (tmp_path / "abc").write_bytes(b"abc")
    assert sha256_of(tmp_path / "abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
