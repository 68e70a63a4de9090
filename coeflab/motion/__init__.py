"""Motions: equations, integrators, manoeuvres, trim, identification, ensembles."""

from __future__ import annotations
