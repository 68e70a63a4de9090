"""HUUV, a hybrid underwater vehicle steered by two thrusters."""
