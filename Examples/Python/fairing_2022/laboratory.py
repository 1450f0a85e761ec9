# SPDX-License-Identifier: BSD-3-Clause
"""What the figures and tables share: rounds that are made once, expectations, and notes."""


class Laboratory:
    """Makes rounds when they are first asked for and keeps the record of what was expected."""

    def __init__(self, quick=False):
        self.quick = quick
        self.lines = []
        self.failures = []
        self._rounds = {}
        self._models = {}

    def rounds(self, name, make):
        if name not in self._rounds:
            self._rounds[name] = make()
        return self._rounds[name]

    def model(self, make):
        if make not in self._models:
            self._models[make] = make(self.quick)
        return self._models[make]

    def record(self, label, made):
        self.lines.append(f"{label}: {made.iterations} iteration(s), fitting error "
                          f"{made.fitting_error:.4g}, energy {made.energy:.5g}")
        self.lines.extend(f"{label}: the filter warns: {text}" for text in made.warnings)
        if made.warnings:
            self.failures.append(f"{label} did not converge")

    def expect(self, claim, holds):
        self.lines.append(f"{claim}: {'yes' if holds else 'NO'}")
        if not holds:
            self.failures.append(claim)

    def note(self, text):
        self.lines.append(f"Note: {text}")

    def flush(self):
        lines, self.lines = self.lines, []
        return lines
