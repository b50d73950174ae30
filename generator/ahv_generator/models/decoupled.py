"""The family of DCOM and SDCOM: thrust is a coefficient, and the table says how many flexible modes there are."""

from __future__ import annotations

import re
from collections.abc import Mapping

from ..family import Family
from ..schema import NOT_ZERO, QuantitySpec, Rule, Schema
from .dcom import CANARD, DELTA_C, build_dcom
from .flexible import CHI, ETA, ETA_DOT, coordinates, index, modal_parameters
from .flight import DELTA_E, EARTH, ENVIRONMENT, PHI, RIGID_STATE, VEHICLE
from .noise import NOISE, noise_parameters
from .printed import build_sdcom_printed
from .reduction import REDUCTION
from .sdcom import ALPHA_GUST, GUST, build_sdcom, build_sdcom_gust

_FORCE = re.compile(r"C_N_[1-9][0-9]*")


def _schema(models: tuple[str, ...], sections: Mapping[str, object]) -> Schema:
    # By their count, not the highest number: a gap in the numbers is a section that is missing and one too many.
    modes = range(1, max(1, sum(_FORCE.fullmatch(section) is not None for section in sections)) + 1)
    coordinate = coordinates(modes)
    control = ("alpha", "delta_e", "delta_c")
    gust = "sdcom_gust" in models

    def fit(letter: str, doc: str, variables: tuple[str, ...], required: tuple[str, ...] = ()) -> QuantitySpec:
        eta = tuple(v.name for v in coordinate)
        key, affine = f"C_{letter}", "the flexible coordinates, as (27) needs it"
        return QuantitySpec(key, key, "1", doc, (*variables, *eta), required, "law (4) needs it", eta, affine)

    def force(i: int) -> QuantitySpec:
        doc = f"generalized-force coefficient of mode {i}"
        return QuantitySpec(f"C_N_{i}", rf"C_{{N_{index(i)}}}", "(ft/slug)^0.5", doc, control)

    return Schema(
        parameters={
            "vehicle": VEHICLE,
            "environment": ENVIRONMENT,
            "modes": modal_parameters(len(modes)),
            "noise": noise_parameters(len(modes)) + (GUST if gust else ()),
        },
        validity=(*RIGID_STATE, ETA, ETA_DOT, CHI, *((ALPHA_GUST,) if gust else ()), PHI, DELTA_E, DELTA_C),
        choices=(CANARD, EARTH, NOISE, REDUCTION),
        quantities=(
            fit("T", "thrust coefficient", ("phi", "alpha")),
            fit("L", "lift coefficient", control, required=("delta_e", "delta_c")),
            fit("D", "drag coefficient", control),
            fit("M", "pitching-moment coefficient", control),
            *map(force, modes),
        ),
        variables=(*RIGID_STATE, PHI, DELTA_E, DELTA_C, *coordinate),
        laws=(Rule("not-zero", ((1.0, ("c_l_delta_c",)),), NOT_ZERO, "law (4) divides by the C_L of `delta_c`"),),
    )


FAMILY = Family(
    "DCOM",
    {
        "dcom": build_dcom,
        "sdcom": build_sdcom,
        "sdcom_printed": build_sdcom_printed,
        "sdcom_gust": build_sdcom_gust,
    },
    _schema,
    audited=("sdcom_printed",),
)
