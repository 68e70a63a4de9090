"""Fresh water, and the speed in it, which everything takes that is told of none."""

from coeflab.law.scaling import Conditions

FRESH_DENSITY = 998.2  # kg/m^3 at 20 deg C, ITTC 7.5-02-01-03 (2011)
FRESH_VISCOSITY = 1.0034e-6  # m^2/s, as above
ROUND_DENSITY = 1000.0  # kg/m^3, of fresh water where a file states none; what uses it says so
FRESH_WATER = Conditions(FRESH_DENSITY, 2.0, FRESH_VISCOSITY)
