"""Every package that `pip install coeflab` brings has a permissive licence, by what it says of itself."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable, Iterable
from importlib.metadata import Distribution, PathDistribution, distribution
from pathlib import Path

from packaging.requirements import Requirement

ROOT = Path(__file__).parents[1]
# SPDX names, and what older packages write; each demands a notice at most.
PERMISSIVE = {
    "MIT", "MIT-CMU", "BSD-2-Clause", "BSD-3-Clause", "0BSD", "ISC", "Apache-2.0", "PSF-2.0", "Zlib", "CC0-1.0", "HPND",
    "Unlicense", "BSL-1.0",
}  # fmt: skip
CLASSIFIED = {
    "MIT License", "BSD License", "Apache Software License", "Python Software Foundation License", "ISC License (ISCL)",
    "zlib/libpng License", "The Unlicense (Unlicense)", "Historical Permission Notice and Disclaimer (HPND)",
}  # fmt: skip


def is_permissive(package: Distribution) -> bool:
    """By its SPDX expression, else by its classifiers, else by a licence named in one word; nothing stated is not."""
    about = package.metadata
    if expression := about.get("License-Expression"):
        names = re.findall(r"[\w.+-]+", expression)
        return set(names) - {"AND", "OR"} <= PERMISSIVE
    listed = [c.rpartition(" :: ")[2] for c in about.get_all("Classifier") or [] if c.startswith("License ::")]
    if listed := [c for c in listed if c != "OSI Approved"]:
        return set(listed) <= CLASSIFIED
    return (about.get("License") or "").strip() in PERMISSIVE


def brought(requirements: Iterable[str], find: Callable[[str], Distribution] = distribution) -> dict[str, Distribution]:
    """The packages that these requirements bring, extras left out."""
    out: dict[str, Distribution] = {}
    waiting = [Requirement(r) for r in requirements]
    while waiting:
        wanted = waiting.pop()
        if wanted.name in out or (wanted.marker is not None and not wanted.marker.evaluate({"extra": ""})):
            continue
        out[wanted.name] = package = find(wanted.name)
        waiting += [Requirement(r) for r in package.requires or []]
    return out


def mandatory() -> list[str]:
    found: list[str] = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["dependencies"]
    return found


def test_licences_of_what_is_installed_are_permissive() -> None:
    found = brought(mandatory())
    assert len(found) > 40
    assert [name for name, package in found.items() if not is_permissive(package)] == []


def test_a_package_of_another_licence_is_found(tmp_path: Path) -> None:
    def planted(name: str) -> Distribution:
        texts = {
            "pulls": "License-Expression: MIT\nRequires-Dist: copyleft",
            "copyleft": "License-Expression: GPL-3.0-only",
            "old": "License: GPLv3\nClassifier: License :: OSI Approved :: GNU General Public License v3 (GPLv3)",
            "silent": "",
            "either": "License-Expression: MIT AND LGPL-2.1-or-later",
        }
        if name not in texts:
            return distribution(name)
        folder = tmp_path / f"{name}-1.dist-info"
        folder.mkdir(exist_ok=True)
        (folder / "METADATA").write_text(f"Metadata-Version: 2.4\nName: {name}\nVersion: 1\n{texts[name]}\n")
        return PathDistribution(folder)

    for name in ("pulls", "copyleft", "old", "silent", "either"):
        found = brought([*mandatory(), name], planted)
        wrong = {n for n, package in found.items() if not is_permissive(package)}
        assert wrong == {"copyleft" if name == "pulls" else name}
