# SPDX-License-Identifier: BSD-3-Clause
"""What the figures share: models, fits that are made once, and what is reported of each fit."""

from dataclasses import dataclass

from .fitting import Fit, fit


@dataclass(frozen=True)
class Outcome:
    """A fit beside what is expected of its contour."""

    label: str
    fit: Fit
    components: int
    closed: bool

    def is_expected(self):
        return self.fit.components == self.components and (self.fit.closed or not self.closed)

    def __str__(self):
        kind = "closed" if self.fit.closed else "with ends"
        text = f"{self.label}: {self.fit.components} component(s), {kind}"
        if not self.is_expected():
            text += f" (expected: {self.components}{', closed' if self.closed else ''})"
        return text


class Laboratory:
    """Fits models and keeps the record: outcomes of the fits and notes to the reader."""

    def __init__(self, library):
        self.library = library
        self.outcomes = []
        self.notes = []
        self._standard_fits = {}

    def standard_fit(self, name):
        """The fit of a model with the settings of the table."""
        if name not in self._standard_fits:
            self._standard_fits[name] = fit(self.library.cloud(name), self.library.settings(name))
        return self._standard_fits[name]

    def record(self, label, made, closed=True):
        """Notes down a fit that a figure shows; returns it."""
        self.outcomes.append(Outcome(label, made, 1, closed))
        self.notes.extend(f"{label}: the filter warns: {text}" for text in made.warnings)
        return made

    def note(self, text):
        self.notes.append(text)

    def note_on_meshes(self, text):
        """A note that is true of the meshes only, not of what --quick takes for them."""
        if not self.library.quick:
            self.notes.append(text)
