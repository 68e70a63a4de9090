"""Stonefish."""
