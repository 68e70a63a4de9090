"""Water of 20 deg C by its density, and fresh water with a speed in it, which everything takes that is told of none."""

from coeflab.law.scaling import Conditions

FRESH_DENSITY = 998.2  # kg/m^3 at 20 deg C, ITTC 7.5-02-01-03 (2011)
FRESH_VISCOSITY = 1.0034e-6  # m^2/s, as above
SEA_DENSITY = 1024.8  # kg/m^3, sea water of 35.2 g/kg at 20 deg C, as above
SEA_VISCOSITY = 1.0508e-6  # m^2/s, as above
ROUND_DENSITY = 1000.0  # kg/m^3, of fresh water where a file states none; what uses it says so
FRESH_WATER = Conditions(FRESH_DENSITY, 2.0, FRESH_VISCOSITY)


def water_of(density: float) -> tuple[str, float]:
    """Which water of 20 deg C has about this density, and its kinematic viscosity, m^2/s: the nearer of fresh and sea water."""
    if density > (FRESH_DENSITY + SEA_DENSITY) / 2.0:
        return "sea", SEA_VISCOSITY
    return "fresh", FRESH_VISCOSITY


def conditions_of(density: float | None, speed: float | None) -> tuple[Conditions | None, tuple[str, ...]]:
    """Conditions of which density or speed is stated, None where neither is, and the names of those that are assumed."""
    if density is None and speed is None:
        return None, ("density", "speed")
    lacking = tuple(name for name, value in (("density", density), ("speed", speed)) if value is None)
    return Conditions(
        FRESH_DENSITY if density is None else density, FRESH_WATER.speed if speed is None else speed
    ), lacking
