"""Gliders: steady glides, cycles, motion in space."""

COMMANDS = {"glide": "Motion", "glider": "Motion"}
FILES = {"glider": "glider_file.GliderFile"}
PLUGINS = {"coeflab.simulators": "simulators"}
