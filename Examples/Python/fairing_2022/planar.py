# SPDX-License-Identifier: BSD-3-Clause
"""Figures 1 to 4: the plane curves, faired as a whole and segment by segment, and knot insertion."""

import numpy as np

from ipia_2019.drawing import BLUE, Sheet, View, points_actor

from . import curves
from .fairing import TOLERANCE, fair_curve
from .pictures import comb_actors, history_actors

TILE = (420, 380)
AIRFOIL_TILE = (620, 270)
SAMPLES = 1501
# The same for all rounds, so that they can be compared.
NOTE_VIEW = View(centre=(2.5, 3.2, 0), half_height=4.6)
AIRFOIL_VIEW = View(centre=(0.5, 0.04, 0), half_height=0.26)
STARFISH_VIEW = View(centre=(0, 0, 0), half_height=1.75)

# Equal weights of the fitting curve and of the energy minimisation; the paper's were lost.
FITTING = 1e-10
NOTE_WEIGHT, NOTE_RAISED = 1e-8, 1e-6
NOTE_SEGMENT = range(40, 50)

AIRFOIL_RAISED = (1e-5, 1e-8, 1e-5)
# Lower rear, nose, upper rear: control points, as the paper goes about it.
AIRFOIL_SEGMENTS = (range(16, 23), range(9, 16), range(2, 9))

STARFISH_WEIGHT, STARFISH_RAISED, STARFISH_LOWERED = 1e-9, 1e-5, 1e-6
STARFISH_SEGMENTS = (range(5, 10), range(18, 23))


def note_rounds():
    """The fit, the energy minimisation, and fairing-PIA with weights raised on a segment."""
    points = curves.note()
    common = {"closed": True, "controls": curves.NOTE_CONTROLS, "samples": SAMPLES}
    fit = fair_curve(points, weights=FITTING, direct=True, **common)
    energy = fair_curve(points, weights=NOTE_WEIGHT, direct=True, **common)
    first = fair_curve(points, weights=NOTE_WEIGHT, iterations=1, tolerance=0, **common)
    weights = np.full(curves.NOTE_CONTROLS, NOTE_WEIGHT)
    weights[NOTE_SEGMENT] = NOTE_RAISED
    # From the paper's start: control points that are data points, not those of another round.
    pia = fair_curve(points, weights=weights, start=data_start(first, points), closed=True,
                     samples=SAMPLES)
    return points, fit, energy, pia


def data_start(made, points):
    """A round whose control points are data points, as the paper begins: P_j = Q_floor(m j / n)."""
    n, m = made.control_count, len(points)
    closed = made.controls.GetFieldData().GetArray("Closed").GetValue(0)
    for j in range(n):
        k = int(np.floor(m * (j - 1) / n)) % m if closed else \
            0 if j == 0 else m - 1 if j == n - 1 else max(m * (j + 1) // n - 1, 0)
        made.controls.GetPoints().SetPoint(j, *points[k])
    return made


def airfoil_rounds():
    """The fit, and after it one round for each segment, whose weights then stay raised."""
    points = curves.airfoil()
    n = curves.AIRFOIL_CONTROLS
    common = {"samples": SAMPLES}
    rounds = [fair_curve(points, weights=FITTING, direct=True, controls=n, **common)]
    weights = np.full(n, FITTING)
    for segment, raised in zip(AIRFOIL_SEGMENTS, AIRFOIL_RAISED):
        weights[segment] = raised
        rounds.append(fair_curve(points, weights=weights, start=rounds[-1], **common))
    return points, rounds


def starfish_rounds():
    """The fit, a round with weights raised on segments, and one with knots inserted there."""
    points = curves.starfish()
    n = curves.STARFISH_CONTROLS
    fit = fair_curve(points, weights=STARFISH_WEIGHT, closed=True, controls=n, samples=SAMPLES,
                     direct=True)
    begin = fair_curve(points, weights=STARFISH_WEIGHT, closed=True, controls=n, iterations=1,
                       tolerance=0)
    weights = np.full(n, STARFISH_WEIGHT)
    for segment in STARFISH_SEGMENTS:
        weights[segment] = STARFISH_RAISED
    first = fair_curve(points, weights=weights, closed=True, start=data_start(begin, points),
                       samples=SAMPLES)
    knots = first.knots
    inserted = []
    for segment in STARFISH_SEGMENTS:
        middle = segment[len(segment) // 2] + 2  # the knot in the middle of that function's support
        inserted += [knots[middle - 1:middle + 1].mean(), knots[middle:middle + 2].mean()]
    refined = fair_curve(points, weights=weights, closed=True, start=first, knots=inserted,
                         iterations=1, tolerance=0, step_size=1e-300, samples=SAMPLES)
    lowered = np.full(refined.control_count, STARFISH_WEIGHT)
    spans = [(knots[s[0]], knots[s[-1] + 4]) for s in STARFISH_SEGMENTS]
    for j in range(refined.control_count):
        centre = refined.knots[j + 1:j + 4].mean()
        if any(low < centre < high for low, high in spans):
            lowered[j] = STARFISH_LOWERED
    second = fair_curve(points, weights=lowered, closed=True, start=refined, samples=SAMPLES)
    return points, fit, first, refined, second


def supports(made, segments):
    """Parameter ranges in which the control points of each segment count."""
    return [(made.knots[s[0]], made.knots[s[-1] + 4]) for s in segments]


def figure_1(lab):
    points, fit, energy, pia = lab.rounds("note", note_rounds)
    box = supports(fit, [NOTE_SEGMENT])
    sheet = Sheet(1, 3, TILE)
    for column, (title, made) in enumerate((("fitting curve", fit), ("energy minimisation", energy),
                                            ("fairing-PIA", pia))):
        sheet.tile(0, column, f"{title}: E_fit {made.fitting_error:.4f}, energy {made.energy:.3g}",
                   [*comb_actors(made, 0.3, box, 1.2), points_actor(points, BLUE, 2)], NOTE_VIEW)
        lab.record(f"Note, {title}", made)
    lab.expect("Note: the segment is fairer by fairing-PIA than by energy minimisation",
               roughness(pia, box[0]) < 0.7 * roughness(energy, box[0]))
    return sheet


def figure_2(lab):
    points, rounds = lab.rounds("airfoil", airfoil_rounds)
    sheet = Sheet(2, 2, AIRFOIL_TILE)
    titles = ("fitting curve", "lower rear", "nose as well", "upper rear as well")
    for k, (title, made) in enumerate(zip(titles, rounds)):
        box = supports(made, AIRFOIL_SEGMENTS[max(k - 1, 0):k])
        sheet.tile(k // 2, k % 2, f"{title}: E_fit {made.fitting_error:.5f}, energy {made.energy:.4g}",
                   [*comb_actors(made, 0.05, box, 0.12), points_actor(points, BLUE, 3)], AIRFOIL_VIEW)
        lab.record(f"Airfoil, {title}", made)
    lab.expect("Airfoil: every segment lowers the energy",
               all(a.energy > b.energy for a, b in zip(rounds, rounds[1:])))
    return sheet


def figure_3(lab):
    points, fit, first, refined, second = lab.rounds("starfish", starfish_rounds)
    box = supports(fit, STARFISH_SEGMENTS)
    sheet = Sheet(2, 2, TILE)
    tiles = (("fitting curve", fit), ("first round", first), ("knots inserted", refined),
             ("second round", second))
    for k, (title, made) in enumerate(tiles):
        sheet.tile(k // 2, k % 2, f"{title}: E_fit {made.fitting_error:.4f}, energy {made.energy:.4g}",
                   [*comb_actors(made, 0.05, box), points_actor(points, BLUE, 4)], STARFISH_VIEW)
        lab.record(f"Starfish, {title}", made)
    lab.expect("Starfish: knot insertion leaves the curve as it is",
               np.abs(first.points - refined.points).max() < 1e-12)
    lab.expect("Starfish: the second round fits better than the first",
               second.fitting_error < first.fitting_error)
    lab.expect("Starfish: it is fairer in the boxes than the fit",
               all(roughness(second, b) < roughness(fit, b) for b in box))
    return sheet


def figure_4(lab):
    sheet = Sheet(1, 4, (330, 300))
    rounds = (("Note", lab.rounds("note", note_rounds)[3]),
              ("Airfoil, last segment", lab.rounds("airfoil", airfoil_rounds)[1][-1]),
              ("Starfish, first round", lab.rounds("starfish", starfish_rounds)[2]),
              ("Starfish, second round", lab.rounds("starfish", starfish_rounds)[4]))
    for column, (title, made) in enumerate(rounds):
        sheet.tile(0, column, f"{title}: {made.iterations} iterations", history_actors(made))
        lab.expect(f"{title}: the iteration error falls to {TOLERANCE:g}",
                   made.iteration_errors[-1] < TOLERANCE)
    lab.note("relative to their largest values: iteration error blue, fitting error red, energy green")
    return sheet


def roughness(made, parameter_range):
    """The root mean square of the change of curvature in a range of parameters."""
    u = made.array("Parameter")
    inside = (u >= parameter_range[0]) & (u <= parameter_range[1])
    curvature = made.array("CurvatureNormal")[inside]
    return np.sqrt((np.diff(curvature, axis=0)**2).sum(axis=1).mean())
