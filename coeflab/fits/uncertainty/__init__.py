"""Budgets, grid convergence and propagation."""

from __future__ import annotations
