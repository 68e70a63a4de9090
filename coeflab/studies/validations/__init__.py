"""Published vehicles reproduced: each module gives an ``Acceptance``."""
