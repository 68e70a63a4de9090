"""The JSON contract of the command line: one object a command, SI and radians, null where there is no value."""
