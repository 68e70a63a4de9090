"""Turn the transcribed SUBOFF tables into coeflab campaigns: unit headers, blank cells, hashes.

Run ``python cfd_data/convert_suboff.py SOURCE`` where SOURCE holds ``suboff_roddy_config{1,2,3}_static.csv`` and
``cfd/suboff_barehull_{drift,rotating_arm}.csv``. No number is touched: cells are copied as text, ``nan`` becomes a blank
cell, and each campaign.toml gets the sha256 of its source and of its table.
"""

from __future__ import annotations

import csv
import hashlib
import io
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
RODDY_HEADERS = {
    "point": "point",
    "deltas_deg": "delta_s [deg]",
    "deltar_deg": "delta_r [deg]",
    "alpha_deg": "alpha [deg]",
    "beta_deg": "beta [deg]",
    "uncertain": "uncertain",
    **{c: f"{c}' [-]" for c in "XYZKMN"},
}
JOBS = [
    *((f"suboff_roddy_config{i}_static.csv", f"suboff_roddy_{i}", "table.csv") for i in (1, 2, 3)),
    ("cfd/suboff_barehull_drift.csv", "suboff_cfd_barehull", "drift.csv"),
    ("cfd/suboff_barehull_rotating_arm.csv", "suboff_cfd_barehull", "rotating_arm.csv"),
]


def converted(text: str) -> str:
    """The table with unit headers; cells as they are, ``nan`` blank, column letters under ``uncertain`` spaced."""
    rows = list(csv.reader(line for line in io.StringIO(text) if not line.startswith("#")))
    header = [RODDY_HEADERS.get(name, name) for name in rows[0]]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    for row in rows[1:]:
        cells = ["" if cell == "nan" else cell for cell in row]
        if header[-1] == "uncertain":
            cells[-1] = " ".join(cells[-1])
        writer.writerow(cells)
    return out.getvalue()


def with_hashes(campaign: str, file: str, source_hash: str, result_hash: str) -> str:
    """campaign.toml with the two hashes of one table entered under its [[table]]."""
    pattern = re.compile(rf'(file = "{re.escape(file)}"\nsha256 = ")[0-9a-f]*("\nsource_sha256 = ")[0-9a-f]*(")')
    changed, count = pattern.subn(rf"\g<1>{result_hash}\g<2>{source_hash}\g<3>", campaign)
    if count != 1:
        raise SystemExit(f"no place for the hashes of {file}")
    return changed


def main(source: Path) -> None:
    """Convert every table below ``source``."""
    for name, folder, file in JOBS:
        raw = (source / name).read_bytes()
        table = converted(raw.decode()).encode()
        (HERE / folder / file).write_bytes(table)
        description = HERE / folder / "campaign.toml"
        hashes = hashlib.sha256(raw).hexdigest(), hashlib.sha256(table).hexdigest()
        description.write_text(with_hashes(description.read_text(), file, *hashes))
        sys.stdout.write(f"{folder}/{file}: {table.count(bytes([10])) - 1} rows\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        raise SystemExit(__doc__)
    main(Path(sys.argv[1]))
