# SPDX-License-Identifier: BSD-3-Clause
"""
Tables 1 to 3, the paper's figures beside ours. Numbers that the published text lost are "-".
"""

from . import curves, surfaces
from .planar import airfoil_rounds, note_rounds, starfish_rounds
from .relief import mean_curvatures, rounds_of
from .space import ENERGIES, viviani_rounds

PAPER_1 = {  # data points, control points, iterations, seconds of energy minimisation (MATLAB)
    "Note": ("245", "83", "64", "0.1509"),
    "Airfoil (last segment)": ("49", "25", "32", "0.01144"),
    "Starfish (first round)": ("100", "34", "23", "0.02133"),
    "Tooth": ("-", "-", "248", "39.3429"),
    "Fan_disk": ("-", "-", "85", "7.4511"),
    "Mannequin": ("-", "-", "143 or 6", "1560.6648"),  # the text has both and does not tell which
}
PAPER_2 = {  # initial fitting error and energy
    "Note": ("0.01074", "90438.9606"),
    "Starfish (first round)": ("0.02725", "15090.0488"),
    "Viviani (r = 1)": ("0.02895", "1455.8978"),
    "Viviani (r = 2)": ("0.02895", "-"),
    "Viviani (r = 3)": ("0.02895", "-"),
    "Tooth": ("0.006903", "236.9693"),
    "Fan_disk": ("0.01002", "73.3475"),
    "Mannequin": ("0.003143", "787.0678"),
}
PAPER_3 = {  # smallest and largest mean curvature of the fit and of the energy minimisation
    "Tooth": (("-15.8553", "1791.7996"), ("-11.9428", "19.2055")),
    "Fan_disk": (("-33.7973", "42.6118"), ("-27.8114", "31.155")),
    "Mannequin": (("-23.3849", "27.0701"), ("-20.3517", "27.0489")),
}


def table_1(lab):
    note, airfoil, starfish = _plane_curves(lab)
    rows = [("Model", "data points, paper", "ours", "control points, paper", "ours",
             "iterations, paper", "ours", "energy minimisation, paper (s)", "ours (s)",
             "fairing-PIA, ours (s)")]
    made = {"Note": (curves.NOTE_POINTS, note[2], note[3]),
            "Airfoil (last segment)": (curves.AIRFOIL_POINTS, airfoil[1][0], airfoil[1][-1]),
            "Starfish (first round)": (curves.STARFISH_POINTS, starfish[1], starfish[2])}
    for make in surfaces.MODELS:
        model, (_, energy, pia) = rounds_of(lab, make)
        made[model.name] = (len(model.points), energy, pia)
    for name, (count, energy, pia) in made.items():
        paper = PAPER_1[name]
        rows.append((name, paper[0], str(count), paper[1], str(pia.control_count), paper[2],
                     str(pia.iterations), paper[3], f"{energy.seconds:.4f}", f"{pia.seconds:.4f}"))
    return _lines(rows)


def table_2(lab):
    note, _, starfish = _plane_curves(lab)
    _, viviani = lab.rounds("viviani", viviani_rounds)
    rows = [("Model", "initial fitting error, paper", "ours", "final, ours", "initial energy, paper",
             "ours", "final, ours")]
    made = {"Note": note[3], "Starfish (first round)": starfish[2]}
    made.update((f"Viviani (r = {order})", viviani[order][-1]) for order in ENERGIES)
    for make in surfaces.MODELS:
        model, rounds = rounds_of(lab, make)
        made[model.name] = rounds[2]
    for name, one in made.items():
        fit, energy = PAPER_2[name]
        rows.append((name, fit, f"{one.fitting_errors[0]:.4g}", f"{one.fitting_error:.4g}", energy,
                     f"{one.energies[0]:.5g}", f"{one.energy:.5g}"))
    return _lines(rows)


def table_3(lab):
    rows = [("Surface", "of", "H from, paper", "ours", "H to, paper", "ours")]
    for make in surfaces.MODELS:
        model, rounds = rounds_of(lab, make)
        paper = (*PAPER_3[model.name], ("-", "-"))
        kinds = ("fitting", "energy minimisation", "fairing-PIA")
        for kind, printed, one in zip(kinds, paper, rounds):
            low, high = mean_curvatures(one)
            rows.append((model.name, kind, printed[0], f"{low:.4f}", printed[1], f"{high:.4f}"))
    return _lines(rows)


def _plane_curves(lab):
    return (lab.rounds("note", note_rounds), lab.rounds("airfoil", airfoil_rounds),
            lab.rounds("starfish", starfish_rounds))


def _lines(rows):
    """As Markdown, lines of equal column widths."""
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    lines = ["| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths)) + " |"
             for row in rows]
    lines.insert(1, "|" + "|".join("-" * (width + 2) for width in widths) + "|")
    return lines
