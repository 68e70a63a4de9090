"""A vehicle with an arm: chain, Kane's equations, control, equations as code."""

COMMANDS = {"derive": "Motion"}
SIMULATES = "commands.simulate_arm"
PLUGINS = {"coeflab.bodies": "readers", "coeflab.simulators": "simulators"}
