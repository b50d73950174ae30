"""Names that the generated code cannot have, or has already."""

from __future__ import annotations

import re
from collections.abc import Iterable

# Of this name is the file beside the IRs that holds the audit of the printed equations.
_AUDIT = "audit"

# Those of every edition, and those that Rust keeps for later.
_KEYWORDS = frozenset(
    "abstract as async await become box break const continue crate do dyn else enum extern false final fn for gen if "
    "impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true try "
    "type typeof unsafe unsized use virtual where while yield".split()
)

# A module of such a name would hide the crate. A test holds them against the manifest of `generated/`.
_CRATES = frozenset({"ahv_core", "nalgebra"})

# Functions of the generated code that no model states, and what ends the names of those that come with another.
_FUNCTIONS = frozenset("intermediates slopes curvatures sensitivities prepare rk4_step euler_maruyama_step".split())
_WITH_ANOTHER = ("_from", "_values")

# The module of a model is a folder beside `lib.rs`, its page a file beside these.
_FILES = frozenset({"lib", "audit", "passes", "readme"})

# A set becomes a constant of the generated code; these stand beside it. A test holds them against `generated/`.
_CONSTANTS = frozenset(
    "nominal provenance sets unit_system validity state_bounds input_bounds noise_class noise_commutes table"
    " degree".split()
)
# So end the constants of the functions' compressed outputs, which no set's may: what these are called, the models say.
_OF_FUNCTIONS = "_pattern"

# Files are named after tables and models; file systems end names at 255 bytes, with what is added to them.
_LONGEST = 64

SET_NAME = re.compile(r"[a-z][a-z0-9._-]*")
SET_LETTERS = "lower-case letters, digits, `.`, `_`, `-`"


def fault_of_identifier(name: object) -> str | None:
    """Why a variable, a parameter or a quantity cannot have this name in the generated code."""
    if not isinstance(name, str) or not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        return f"`{name}` is not a lower-case identifier: letters a to z, digits, `_`"
    return f"`{name}` is a keyword of Rust; choose another name" if name in _KEYWORDS else None


def fault_of_model(name: object) -> str | None:
    """Why a model cannot have this name, which is that of a module at the root of the package."""
    if name in _CRATES:
        return f"`{name}` is a crate that the generated code needs; choose another name"
    if name in _FILES:
        return f"`{name}` is a file of the generated package; choose another name"
    return fault_of_identifier(name) or _fault_of_length(str(name))


def _fault_of_length(name: str) -> str | None:
    if len(name) > _LONGEST:
        return f"the name has {len(name)} letters; it names files, and may have {_LONGEST}"
    return None


def fault_of_texts(*texts: str) -> str | None:
    """Why these cannot be symbols, texts or titles, which stand in one line of the generated code."""
    for text in texts:
        if not text.isprintable():
            return f'{text!r} has a control character; write LaTeX as a raw string, like r"\\alpha"'
    return None


def fault_of_quantity(name: str) -> str | None:
    """Why a quantity that a model defines cannot have this name in the generated code."""
    if name in ("x", "u", "w", "p", "t"):
        return f"`{name}` is the name of a vector in the generated code; choose a longer name"
    if re.match(r"d\d?_|slope_of_", name):
        return f"`{name}` would be taken for a derivative; choose a name that does not begin with `d_`"
    return fault_of_identifier(name)


def fault_of_functions(functions: Iterable[str]) -> str | None:
    """Why a model cannot have functions of these names."""
    stated = list(functions)
    made = _FUNCTIONS.union(f"{name}{ending}" for name in stated for ending in _WITH_ANOTHER)
    clash = next((name for name in stated if name in made), None)
    return None if clash is None else f"`{clash}` is a function of the generated code already; choose another name"


def fault_of_table(name: object) -> str | None:
    """Why a table cannot have this name."""
    if not isinstance(name, str) or not re.fullmatch(r"[a-z][a-z0-9_]*", name):
        return "`name` must be a lower-case identifier: letters a to z, digits, `_`"
    if name in _KEYWORDS:
        return f"`{name}` is a keyword of Rust; choose another name"
    if name == _AUDIT:
        return f"`name` must be other than `{_AUDIT}`, which is the audit of the printed equations"
    return _fault_of_length(name)


def constants(name: str) -> frozenset[str]:
    """The constants that a set makes, in lower case: `section5.3` makes SECTION5_3 and SECTION5_3_PROVENANCE."""
    constant = re.sub("[._-]", "_", name)
    return frozenset((constant, f"{constant}_provenance"))


def fault_of_set(name: str, taken: frozenset[str]) -> str | None:
    """Why a set cannot have this name beside sets that make the constants `taken`."""
    if not SET_NAME.fullmatch(name):
        return f"a set has a name of its own, of {SET_LETTERS}"
    made = constants(name)
    clash = sorted(c for c in made if c in _CONSTANTS or c in taken or c.endswith(_OF_FUNCTIONS))
    if clash:
        return f"a set has a name of its own: `{name}` would make the constant {clash[0].upper()} once more"
    return None
