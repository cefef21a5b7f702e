"""The part of lowlap that is written in Python."""

import abc


class Error(Exception):
    """What went wrong.

    code: for a program to branch on ("invalid_argument", "not_found", "io",
    "parse", "invalid_scene", "unsupported", "insufficient_data", "numerical",
    "cancelled"); message, file and place: for a person, the last two empty
    where they mean nothing.
    """

    def __init__(self, code, message, file="", place=""):
        super().__init__(code, message, file, place)
        self.code = code
        self.message = message
        self.file = file
        self.place = place

    def __str__(self):
        return ": ".join(part for part in (self.file, self.place, self.message) if part)


class TranslationAverager(abc.ABC):
    """A translation averaging strategy: derive from it, and give an object to
    solve(scene, strategy=...) or compare(scene, truth, [...])."""

    @abc.abstractmethod
    def name(self):
        """A word without any of ":,=+" and spaces."""

    @abc.abstractmethod
    def solve(self, problem):
        """The centres of the views of a TranslationProblem.

        An (n, 3) array, a row for each of problem.views, NaN for views that
        are not placed; or a pair of such an array and the component of every
        view (-1: not placed), if not all centres share a scale. A problem that
        cannot be solved is an Error.
        """

    def needs_tracks(self):
        """Whether solve() looks at problem.tracks."""
        return False

    def needs(self):
        """Completes the sentence "a view needs ..."."""
        return "what the strategy works with"
