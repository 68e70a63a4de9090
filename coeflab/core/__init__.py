"""Errors, units, axes, provenance, citations, the registry of plugins: what every subject needs."""
