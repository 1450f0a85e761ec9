# SPDX-License-Identifier: BSD-3-Clause
"""What the step size tau of the weights does: Examples 1 and 4 after 200 iterations."""

from .fitting import Settings, fit

GRIDS = {1: 9, 4: 15}
STEPS = (None, 1e-2, 1, 10, 100, 1000)
HEADER = ("Example", "tau", "weights", "E", "E_max", "E_ave")


def step_lines(lab):
    lines = ["| " + " | ".join(HEADER) + " |", "|---" * len(HEADER) + "|"]
    for example, grid in GRIDS.items():
        for tau in STEPS:
            made = fit(lab.cloud(example), Settings(grid, tau, iterations=200, tolerance=0.0))
            name = "B-spline" if tau is None else f"{tau:g}"
            lines.append(
                f"| {example} | {name} | {made.smallest_weight:.3f} to {made.largest_weight:.3f} | "
                f"{made.energy:.3g} | {made.max_error:.3g} | {made.average_error:.3g} |")
    return lines
