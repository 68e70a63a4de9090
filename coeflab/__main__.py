"""``python -m coeflab``: the command line."""

from coeflab.cli import main

if __name__ == "__main__":
    main()
