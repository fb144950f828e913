"""The errors of the toolkit as exceptions."""


class Error(Exception):
    """What went wrong, where, and the remedy.

    Attributes
    ----------
    kind : "input", "failure" or "usage"
    where : the file, the element or the operation; may be empty
    problem : what is wrong with it
    remedy : what to do about it; may be empty
    """

    kind = ""

    def __init__(self, problem: str, where: str = "", remedy: str = "") -> None:
        super().__init__(problem, where, remedy)
        self.problem = problem
        self.where = where
        self.remedy = remedy

    def __str__(self) -> str:
        text = f"{self.where}: {self.problem}" if self.where else self.problem
        return f"{text} ({self.remedy})" if self.remedy else text


class InputError(Error):
    """A file, a mesh or an array is not what it should be."""

    kind = "input"


class WorkError(Error):
    """The work could not be done: no space, no solution."""

    kind = "failure"


class UsageError(Error, ValueError):
    """Options or names that make no sense."""

    kind = "usage"


class ArgumentError(UsageError, TypeError):
    """A function has no such parameter, or one that it needs is missing."""


for _class in (Error, InputError, WorkError, UsageError, ArgumentError):
    _class.__module__ = "ostraka"
