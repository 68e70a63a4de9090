"""Commands about measured motions."""
