# SPDX-License-Identifier: BSD-3-Clause
"""Figures 5 and 6: Viviani's curve with noise, for the three energies."""

import numpy as np

from ipia_2019.drawing import BLUE, Sheet, View, points_actor

from . import curves
from .fairing import fair_curve
from .pictures import comb_actors, history_actors
from .planar import data_start

SAMPLES = 1501
VIEW = View(direction=(1.0, -0.9, 0.6), up=(0, 0, 1))
ENERGIES = {1: "stretch", 2: "strain", 3: "jerk"}
SHARE = 0.4  # of the control points, those with the largest second differences
# High and low weights by the order; the energies differ by the square of a wave number.
WEIGHTS = {1: (2e-2, 1e-2), 2: (1e-5, 1e-6), 3: (3e-8, 1e-9)}
SHOWN_ITERATIONS = (0, 3, 12)


def second_differences(points):
    return np.linalg.norm(np.roll(points, 1, 0) - 2 * points + np.roll(points, -1, 0), axis=1)


def viviani_rounds():
    """For each energy the start, the curve after a few iterations, and the limit."""
    points = curves.viviani()
    n = curves.VIVIANI_CONTROLS
    rounds = {}
    for order, (high, low) in WEIGHTS.items():
        def start(order=order):
            return data_start(fair_curve(points, closed=True, controls=n, order=order, iterations=1,
                                         tolerance=0), points)
        chosen = np.array([int(np.floor(len(points) * (j - 1) / n)) % len(points) for j in range(n)])
        measure = second_differences(points)[chosen]
        weights = np.where(np.argsort(np.argsort(-measure)) < round(SHARE * n), high, low)
        common = {"closed": True, "order": order, "weights": weights, "samples": SAMPLES}
        rounds[order] = [
            fair_curve(points, start=start(), iterations=max(count, 1), tolerance=0,
                       step_size=0 if count else 1e-300, **common) for count in SHOWN_ITERATIONS]
        rounds[order].append(fair_curve(points, start=start(), **common))
    return points, rounds


def figure_5(lab):
    points, rounds = lab.rounds("viviani", viviani_rounds)
    sheet = Sheet(len(WEIGHTS), len(SHOWN_ITERATIONS) + 1, (330, 300))
    for row, (order, made) in enumerate(rounds.items()):
        for column, one in enumerate(made):
            count = SHOWN_ITERATIONS[column] if column < len(SHOWN_ITERATIONS) else one.iterations
            sheet.tile(row, column, f"r = {order}, iteration {count}: E_fit {one.fitting_error:.4f}",
                       [*comb_actors(one, 0.05), points_actor(points, BLUE, 2)], VIEW)
        lab.record(f"Viviani, r = {order}", made[-1])
        lab.expect(f"Viviani, r = {order}: the {ENERGIES[order]} energy falls",
                   made[-1].energy < made[0].energy)
    return sheet


def figure_6(lab):
    _, rounds = lab.rounds("viviani", viviani_rounds)
    sheet = Sheet(1, len(WEIGHTS), (330, 300))
    for column, (order, made) in enumerate(rounds.items()):
        sheet.tile(0, column, f"r = {order}: {made[-1].iterations} iterations",
                   history_actors(made[-1]))
    lab.note("relative to their largest values: iteration error blue, fitting error red, energy green")
    return sheet
