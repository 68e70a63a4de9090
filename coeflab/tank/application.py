"""The virtual tow tank: test matrix, meshes, cases, runs."""

COMMANDS = {"tow": "Data"}
FILES = {"tank": "tank_keys.TankFile"}
