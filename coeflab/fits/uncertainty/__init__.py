"""Budgets, grid convergence and propagation."""
