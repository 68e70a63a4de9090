"""Closed triangulated surfaces: files, gates, repair, topology, decimation."""
