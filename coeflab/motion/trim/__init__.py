"""Steady motions and operating points."""
