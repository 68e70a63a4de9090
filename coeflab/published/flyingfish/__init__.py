"""TJ-FlyingFish, a quadrotor of air and water with tilting rotors."""

from __future__ import annotations
