"""Floor 0: errors, axes, units, symbols, provenance, citations, registry."""
