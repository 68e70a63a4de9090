"""Published systems, reproduced."""

VALIDATIONS = "acceptance"
