"""The models, each built from a checked table."""

from __future__ import annotations

from collections.abc import Callable

from ..model import Model
from ..table import Table
from .com import build_com, build_com_rigid
from .dcom import build_dcom
from .flexible_mode import build_flexible_mode
from .printed import build_sdcom_printed
from .sdcom import build_sdcom, build_sdcom_gust

BUILDERS: dict[str, Callable[[Table], Model]] = {
    "com": build_com,
    "com_rigid": build_com_rigid,
    "dcom": build_dcom,
    "sdcom": build_sdcom,
    "sdcom_printed": build_sdcom_printed,
    "sdcom_gust": build_sdcom_gust,
    "flexible_mode": build_flexible_mode,
}
