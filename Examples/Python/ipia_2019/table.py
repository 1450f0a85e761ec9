# SPDX-License-Identifier: BSD-3-Clause
"""Tables 1 and 2 of the paper as one, its figures beside ours."""

from .fitting import ITERATIONS
from .models import MODELS

HEADER = ("Model", "ours", "points", "grid", "iterations", "components", "max error, paper",
          "max error, ours", "time, paper (s)", "time, ours (s)")


def table_lines(lab):
    """The table as Markdown, lines of equal column widths."""
    rows = [HEADER] + [_row(lab, model) for model in MODELS.values()]
    widths = [max(len(row[column]) for row in rows) for column in range(len(HEADER))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |"
             for row in rows]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return lines


def _row(lab, model):
    made = lab.standard_fit(model.name)
    settings = lab.library.settings(model.name)
    if model.remark:
        lab.note_on_meshes(f"{model.name}: {model.remark}")
    return (model.name, lab.library.source(model.name), str(len(lab.library.cloud(model.name))),
            f"{settings.grid}^{2 if model.planar else 3}", str(ITERATIONS), str(made.components),
            f"{model.paper_error:.3g}", f"{made.max_error:.3g}",
            f"{model.paper_seconds:g}", f"{made.seconds:.2f}")
