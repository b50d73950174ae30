"""The rigid vehicle of Parker et al. (2007) with a canard. The table is `parker_canard.toml`.

Equations, trim and modes are those of the built-in family `com`; the canard is one more variable of its curve fits.
"""

from ahv_generator.families.com import define_forces, finish
from ahv_generator.modelling import Family, Model, Quantity
from ahv_generator.models.dcom import DELTA_C
from ahv_generator.models.flight import (
    ALPHA,
    DELTA_E,
    EARTH,
    ENVIRONMENT,
    PHI,
    RIGID_STATE,
    VEHICLE,
    steady_flight,
)
from ahv_generator.models.vehicle import define_rigid_rates

INPUT = (PHI, DELTA_E, DELTA_C)
CONTROL = (ALPHA, DELTA_E, DELTA_C)

family = Family()
family.parameters("vehicle", *VEHICLE)
family.parameters("environment", *ENVIRONMENT)
family.choices(EARTH)
family.quantities(
    Quantity("T", "T", "lb/ft", "thrust", (PHI, ALPHA)),
    Quantity("C_L", "C_L", "1", "lift coefficient", CONTROL),
    Quantity("C_D", "C_D", "1", "drag coefficient", CONTROL),
    Quantity("C_M", "C_M", "1", "pitching-moment coefficient", CONTROL),
)
family.bounds(*RIGID_STATE, *INPUT)


@family.model("parker_canard", "rigid vehicle with a canard", "(1)-(3)", states=RIGID_STATE, inputs=INPUT)
def parker_canard(model: Model) -> None:
    """The rigid body; a trim holds the canard."""
    finish(model, define_rigid_rates(model, define_forces(model)))
    steady_flight(model, {})
