"""Write the HUUV's parameter file from its constants: ``python cfd_data/make_huuv.py``."""

from __future__ import annotations

from coeflab.core.files import shipped, write_atomically
from coeflab.published.huuv.model import parameter_file, read_huuv

if __name__ == "__main__":
    write_atomically(shipped("cfd_data") / "huuv" / "huuv.parameters.json", parameter_file(read_huuv()).to_json())
