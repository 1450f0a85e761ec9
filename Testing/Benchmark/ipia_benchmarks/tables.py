# SPDX-License-Identifier: BSD-3-Clause
"""Markdown."""
import math


def table(header, rows):
    """A table whose first column is text and whose others are figures."""
    lines = [header, ["---"] + ["---:"] * (len(header) - 1)] + rows
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def figure(value, digits=3):
    """A number with so many significant digits; a dash for None."""
    if value is None:
        return "–"
    if value == 0:
        return "0"
    return f"{value:.{max(0, digits - 1 - math.floor(math.log10(abs(value))))}f}"


def geometric_mean(values):
    """None without values."""
    values = [value for value in values if value]
    return math.exp(sum(map(math.log, values)) / len(values)) if values else None
