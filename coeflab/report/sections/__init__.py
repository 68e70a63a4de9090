"""Sections of a report, one subject a file."""
