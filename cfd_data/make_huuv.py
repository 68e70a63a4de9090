"""Write the HUUV's parameter files from its constants: ``python cfd_data/make_huuv.py``."""

from __future__ import annotations

from coeflab.core.files import shipped, write_atomically
from coeflab.published.huuv.five_dof import read_five_dof
from coeflab.published.huuv.five_dof_file import five_dof_file
from coeflab.published.huuv.model import parameter_file, read_huuv

if __name__ == "__main__":
    huuv = read_huuv()
    for made in (parameter_file(huuv), five_dof_file(read_five_dof(huuv))):
        write_atomically(shipped("cfd_data") / made.name / f"{made.name}.parameters.json", made.to_json())
