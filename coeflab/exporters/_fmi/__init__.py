"""What the FMU of ``coeflab.exporters.fmi`` runs: not a plugin, and never imported by coeflab."""
