# SPDX-License-Identifier: BSD-3-Clause
"""Figures 7 to 10: the stand-ins for the surfaces, with zebra stripes and mean curvature."""

import numpy as np

from ipia_2019.drawing import BLUE, Sheet, View, points_actor

from . import surfaces
from .fairing import fair_surface
from .pictures import curvature_actor, zebra_actor

TILE = (420, 360)
VIEW = View(direction=(0.25, -0.75, 1.0), up=(0, 0, 1))
FITTING = 1e-12
SAMPLES, QUICK_SAMPLES = 241, 81
# The rim of curvature maps, where curvature has end effects.
RIM = 0.03


def surface_rounds(model, quick):
    """The fit, the energy minimisation, and fairing-PIA with weights raised in regions."""
    samples = (QUICK_SAMPLES,) * 2 if quick else (SAMPLES,) * 2
    common = {"controls": model.controls, "samples": samples, "parametrization": "Uniform"}
    fit = fair_surface(model.points, model.size, weights=FITTING, direct=True, **common)
    energy = fair_surface(model.points, model.size, weights=model.weight, direct=True, **common)
    begin = fair_surface(model.points, model.size, weights=model.weight, iterations=1, tolerance=0,
                         **common)
    pia = fair_surface(model.points, model.size, weights=model.weights(),
                       start=data_start(begin, model), samples=samples, parametrization="Uniform")
    return fit, energy, pia


def data_start(made, model):
    """A round whose control points are data points, as the paper begins."""
    chosen = [np.array([0, *(max(m * (j + 1) // n - 1, 0) for j in range(1, n - 1)), m - 1])
              for m, n in zip(model.size, model.controls)]
    ids = (chosen[0][None, :] + model.size[0] * chosen[1][:, None]).ravel()
    for j, k in enumerate(ids):
        made.controls.GetPoints().SetPoint(j, *model.points[k])
    return made


def rounds_of(lab, make):
    model = lab.model(make)
    return model, lab.rounds(model.name, lambda: surface_rounds(model, lab.quick))


def mean_curvatures(made):
    """Smallest and largest mean curvature, without the rim."""
    parameter = made.array("Parameter")
    inside = ((parameter > RIM) & (parameter < 1 - RIM)).all(axis=1)
    curvature = made.array("MeanCurvature")[inside]
    return curvature.min(), curvature.max()


def figure_7(lab):
    sheet = Sheet(1, len(surfaces.MODELS), TILE)
    for column, make in enumerate(surfaces.MODELS):
        model = lab.model(make)
        sheet.tile(0, column, f"{model.name}: {model.title}, {len(model.points)} points",
                   [points_actor(model.points, BLUE, 2)], VIEW)
    return sheet


def _figure(lab, make):
    model, rounds = rounds_of(lab, make)
    sheet = Sheet(2, 3, TILE)
    titles = ("fitting surface", "energy minimisation", "fairing-PIA")
    largest = max(abs(value) for value in mean_curvatures(rounds[2]))
    for column, (title, made) in enumerate(zip(titles, rounds)):
        sheet.tile(0, column, f"{title}: E_fit {made.fitting_error:.5f}", [zebra_actor(made)], VIEW)
        low, high = mean_curvatures(made)
        sheet.tile(1, column, f"H from {low:.1f} to {high:.1f}", [curvature_actor(made, largest)], VIEW)
        lab.record(f"{model.name}, {title}", made)
    lab.expect(f"{model.name}: both are fairer than the fit",
               max(rounds[1].energy, rounds[2].energy) < rounds[0].energy)
    return sheet


def figure_8(lab):
    return _figure(lab, surfaces.tooth)


def figure_9(lab):
    return _figure(lab, surfaces.fan_disk)


def figure_10(lab):
    return _figure(lab, surfaces.mannequin)
