#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""
Reproduces the figures and tables of

  Y. Jiang, H. Lin: Fairing-PIA: progressive-iterative approximation for fairing curve and surface
  generation, 2022

with vtkFairingPIACurveFilter and vtkFairingPIASurfaceFilter: one PNG per figure, and Tables 1 to 3 on
the console. The data of the paper are not public: curves and surfaces are generated and share kind
and size with the paper's, the surfaces their names only. Rendering needs a display; without one run
it under xvfb-run -a.

  PYTHONPATH=<build>/lib/python3/dist-packages python3 reproduce_fairing_pia_2022.py
"""

import argparse
from pathlib import Path
import sys
import time

from fairing_2022.fairing import TOLERANCE
from fairing_2022.laboratory import Laboratory
from fairing_2022.planar import figure_1, figure_2, figure_3, figure_4
from fairing_2022.relief import figure_7, figure_8, figure_9, figure_10
from fairing_2022.space import figure_5, figure_6
from fairing_2022.tables import table_1, table_2, table_3

FIGURES = {"fig1": figure_1, "fig2": figure_2, "fig3": figure_3, "fig4": figure_4,
           "fig5": figure_5, "fig6": figure_6, "fig7": figure_7, "fig8": figure_8,
           "fig9": figure_9, "fig10": figure_10}
TABLES = {"table1": table_1, "table2": table_2, "table3": table_3}
DEFAULT_OUTPUT = Path("ipia-output/fairing-2022")

SETTINGS = f"""\
Settings: cubic splines, parameters by chord length in [0, 1] (surfaces: uniform), knots and first
control points as in the paper. Weights and the bound of the iteration error were lost from the
published text; here it is {TOLERANCE:g}, and the weights are in the code of each figure.
Times are of one update with sampling; the paper's are of MATLAB on an Intel Core i7-10700."""


def main():
    options = _parse_arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    lab = Laboratory(options.quick)
    print(SETTINGS)
    begin = time.perf_counter()
    for name in options.only:
        if name in TABLES:
            print(f"\n{name}")
            print("\n".join(TABLES[name](lab)))
        else:
            _make_figure(lab, name, options.output / f"{name}.png")
        for line in lab.flush():
            print(f"  {line}")
    print(f"\n{time.perf_counter() - begin:.0f} s in all")
    return "unexpected: " + "; ".join(lab.failures) if lab.failures else 0


def _parse_arguments():
    parser = argparse.ArgumentParser(description="Reproduces the paper on fairing-PIA of 2022.")
    names = [*FIGURES, *TABLES]
    parser.add_argument("--only", nargs="+", choices=names, metavar="NAME", default=names,
                        help="what to make: " + ", ".join(names))
    parser.add_argument("--output", type=Path, default=DEFAULT_OUTPUT,
                        help="folder of the pictures (default: %(default)s)")
    parser.add_argument("--quick", action="store_true", help="small surfaces")
    return parser.parse_args()


def _make_figure(lab, name, path):
    path.unlink(missing_ok=True)
    FIGURES[name](lab).write(path)
    if not path.is_file():
        sys.exit(f"reproduce_fairing_pia_2022.py: {path} could not be written")
    print(f"\n{path}")


if __name__ == "__main__":
    sys.exit(main())
