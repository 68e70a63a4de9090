"""Coefficients from motions: time series, steady turns, bench tests of thrusters."""

COMMANDS = {"identify": "Motion", "tune": "Motion"}
FILES = {"tuning": "tuning_plan.TuningFile"}
