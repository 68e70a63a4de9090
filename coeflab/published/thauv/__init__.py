"""THAUV, a twin-hull glider."""
