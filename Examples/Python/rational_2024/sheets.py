# SPDX-License-Identifier: BSD-3-Clause
"""Extra loops of f = 0 by what prevents them: lambda, the far field, the hierarchy."""

from .examples import TABLE_2, TABLE_4
from .fitting import apply_domain, contour_of, extra_loops, largest_distance, new_fitter, prepare

HEADER = ("Example", "spline alone", "lambda", "far field", "hierarchy")


def sheet_lines(lab):
    """Of each fit the extra loops, and the largest distance of a point from the curve, f / |grad f|."""
    lines = ["| " + " | ".join(HEADER) + " |", "|---" * len(HEADER) + "|"]
    rows = TABLE_2 + TABLE_4
    for without, with_ in zip(rows[::2], rows[1::2]):
        cloud = lab.cloud(without.example)
        fits = (lab.fit(without), lab.fit(with_))
        classic = new_fitter(cloud)
        prepare(classic, cloud, without.settings)
        hierarchy = new_fitter(cloud)
        apply_domain(hierarchy, cloud, without.settings)
        cells = [f"{made.extra}, {made.largest_distance:.2g}" for made in fits]
        for fitter in (classic, hierarchy):
            fitter.Update()
            cells.append(f"{extra_loops(contour_of(fitter.GetOutput()))}, "
                         f"{largest_distance(fitter):.2g}")
        lines.append(f"| {without.example} | " + " | ".join(cells) + " |")
    return lines

