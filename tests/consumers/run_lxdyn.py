"""Run one xdyn file in the real simulator; to be started with the interpreter that has lxdyn.

python run_lxdyn.py FILE SECONDS STEP     exit code 0 if it ran to its end; messages on standard error
"""

import sys

import xdyn


def main() -> int:
    """Give xdyn its arguments and pass on what it says."""
    arguments = xdyn.XdynCommandLineArguments()
    arguments.yaml_filenames = [sys.argv[1]]
    arguments.tstart, arguments.tend, arguments.initial_timestep = 0.0, float(sys.argv[2]), float(sys.argv[3])
    arguments.solver = "rk4"
    arguments.catch_exceptions = True
    errors = xdyn.ErrorReporter()
    ran = xdyn.run(arguments, errors)
    sys.stderr.write(errors.get_message())
    return 0 if ran and not errors.contains_errors() else 1


if __name__ == "__main__":
    raise SystemExit(main())
