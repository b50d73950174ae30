"""What goes wrong, with the texts of the command line."""


class AhvError(Exception):
    """Whatever ahv raises."""


class RequestError(AhvError, ValueError):
    """The request cannot be carried out: a name, shape or value that is wrong, a file that cannot be read or written.

    The command line ends with exit code 2 then.
    """


class NumericError(AhvError, ArithmeticError):
    """The computation failed: no trim, a state that is not finite. The command line ends with exit code 3 then."""


class AhvWarning(UserWarning):
    """What a command says beside its outcome: a point outside the validity box, an input without effect."""
