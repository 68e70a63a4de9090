"""Meshes of a towed body by snappyHexMesh: the case, its job, and what shows that a mesh is sound."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from coeflab.tank.jobs import Job
from coeflab.tank.openfoam.mesh_sizes import MeshKeys
from coeflab.tank.tank import Grid, Tank
from coeflab.tank.test_matrix import Half
from coeflab.tank.towed_body import TowedBody

FAR, CUT = "far", "cut"  # patches beside those of the body; the cut is a symmetryPlane


def mesh_name(grid: Grid, half: Half, controls: Mapping[str, float], domain: float = 1.0) -> str:
    """Name of a mesh's job and, below the folder of the tow, its folder: ``mesh/medium_upper``."""
    raise NotImplementedError


def mesh_job(
    tank: Tank,
    body: TowedBody,
    grid: Grid,
    half: Half,
    controls: Mapping[str, float],
    options: MeshKeys,
    folder: Path,
    version: str,
    domain: float = 1.0,
) -> Job:
    """Write the case of a mesh below the folder of the tow, and give its job; equal files are left alone.

    Parameters
    ----------
    tank : Tank
        Its speed and viscosity set the layers, its cores share the work.
    body : TowedBody
        With its controls at the angles of ``controls``.
    grid : Grid
    half : Half
    controls : mapping of str to float
        rad; they name the mesh.
    options : MeshKeys
    folder : Path
        Of the tow.
    version : str
        Of OpenFOAM; part of the key.
    domain : float
        Factor on the distances to the ends of the domain.

    Returns
    -------
    Job
        Polyhedral mesh in ``constant/polyMesh``, patches of the body, ``far`` and, of a half, ``cut``.

    Raises
    ------
    InputError
        The body reaches through the end of the domain, or the mesh would have too many cells.
    """
    raise NotImplementedError


def mesh_ended(job: Job) -> tuple[tuple[str, ...], str]:
    """Remarks on a mesh that was made, and why it is not sound; an empty reason where it is."""
    raise NotImplementedError


def expected_cells(job_folder: Path) -> float:
    """Cells that the mesh of that folder has, once made, else those expected; runs estimate their time from it."""
    raise NotImplementedError
