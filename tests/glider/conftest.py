"""The command line as a real process."""

from tests.cli.conftest import coeflab, fresh

__all__ = ["coeflab", "fresh"]
