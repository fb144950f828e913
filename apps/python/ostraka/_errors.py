"""The errors of the toolkit as exceptions."""


class Error(Exception):
    """An error of the toolkit: the problem, its place and the remedy.

    Attributes
    ----------
    kind : "input", "failure" or "usage"
    where : the file, the element or the operation; may be empty
    problem : description of the problem
    remedy : how to solve it; may be empty
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
    """A file, a mesh or an array is invalid."""

    kind = "input"


class WorkError(Error):
    """The work could not be completed: not enough space, no solution."""

    kind = "failure"


class UsageError(Error, ValueError):
    """Invalid options or names."""

    kind = "usage"


class ArgumentError(UsageError, TypeError):
    """A function has no such parameter, or a required one is missing."""


for _class in (Error, InputError, WorkError, UsageError, ArgumentError):
    _class.__module__ = "ostraka"
