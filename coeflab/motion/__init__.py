"""Motions: equations, integrators, manoeuvres, trim, identification, ensembles."""
