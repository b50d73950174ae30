"""The models, each built from a checked table."""

from __future__ import annotations

from collections.abc import Callable

from ..model import Model
from ..table import Table
from .com import build_com
from .dcom import build_dcom
from .sdcom import build_sdcom

BUILDERS: dict[str, Callable[[Table], Model]] = {"com": build_com, "dcom": build_dcom, "sdcom": build_sdcom}
