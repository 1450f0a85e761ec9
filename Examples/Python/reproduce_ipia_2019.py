#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""
Reproduces the figures and tables of

  Y. F. Hamza, H. Lin, Z. Li: Implicit progressive-iterative approximation for curve and surface
  reconstruction. Computer Aided Geometric Design 77, 2020 (preprint of 2019)

with vtkIPIAImplicitFitter: one PNG per figure, and Tables 1 and 2 as one table on the console.
Rendering needs a display; without one run it under xvfb-run -a.

  PYTHONPATH=<build>/lib/python3/dist-packages python3 reproduce_ipia_2019.py
"""

import argparse
from pathlib import Path
import sys
import time

from ipia_2019.details import figure_6, figure_7, figure_8
from ipia_2019.fitting import DOMAIN_HALF_SIDE, ITERATIONS
from ipia_2019.iterations import figure_1, figure_2
from ipia_2019.laboratory import Laboratory
from ipia_2019.meshes import MeshError, mesh_folder
from ipia_2019.models import ModelLibrary
from ipia_2019.offsets import figure_3
from ipia_2019.robustness import figure_4, figure_5
from ipia_2019.table import table_lines

FIGURES = {"fig1": figure_1, "fig2": figure_2, "fig3": figure_3, "fig4": figure_4,
           "fig5": figure_5, "fig6": figure_6, "fig7": figure_7, "fig8": figure_8}
TABLE = "table"
DEFAULT_OUTPUT = Path("ipia-output/paper-2019")

SETTINGS = f"""\
Settings (the paper gives neither its offset distances and values nor its iteration counts):
  every model is centred with the longest side of its bounding box 1; Omega is the cube (square)
  [-{DOMAIN_HALF_SIDE}, {DOMAIN_HALF_SIDE}]^d, for the gyroid [-0.5, 0.5]^3; {ITERATIONS} iterations
  from zero with the paper's mu; offset points on both sides at 1.5 knot spacings, less where another data point would be nearer;
  f there is plus or minus that distance, so that errors |f| are distances in units of the longest
  side. What differs in a figure is noted below it.
  Times are of one fit with sampling, on the cores of this machine; the paper's are of MATLAB on an
  Intel Core i7 at 3.6 GHz."""


def main():
    options = _parse_arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    lab = Laboratory(ModelLibrary(lambda: mesh_folder(options.data, options.output),
                                  options.quick))
    print(SETTINGS)
    start = time.perf_counter()
    try:
        for name in options.only:
            if name == TABLE:
                _print_table(lab)
            else:
                _make_figure(lab, name, options.output / f"{name}.png")
            _print_notes(lab)
    except MeshError as error:
        return f"reproduce_ipia_2019.py: {error}"
    print(f"\n{time.perf_counter() - start:.0f} s in all")
    return _unexpected(lab) if options.quick else 0


def _parse_arguments():
    parser = argparse.ArgumentParser(description="Reproduces the paper on I-PIA of 2019.")
    parser.add_argument("--only", nargs="+", choices=[*FIGURES, TABLE], metavar="NAME",
                        default=[*FIGURES, TABLE],
                        help="what to make: " + ", ".join([*FIGURES, TABLE]))
    parser.add_argument("--output", type=Path, default=DEFAULT_OUTPUT,
                        help="folder of the pictures (default: %(default)s)")
    parser.add_argument("--data", type=Path,
                        help="folder with the meshes of Debian's package libcgal-demo; without it "
                             "the package is fetched with apt-get download into the output folder")
    parser.add_argument("--quick", action="store_true",
                        help="small grids and no meshes; fails unless every figure is written and "
                             "every contour has the expected number of components")
    return parser.parse_args()


def _make_figure(lab, name, path):
    known = len(lab.outcomes)
    path.unlink(missing_ok=True)
    FIGURES[name](lab).write(path)
    if not path.is_file():
        sys.exit(f"reproduce_ipia_2019.py: {path} could not be written")
    print(f"\n{path}")
    for outcome in lab.outcomes[known:]:
        print(f"  {outcome}")


def _print_table(lab):
    print()
    for line in table_lines(lab):
        print(line)


def _print_notes(lab):
    for note in lab.notes:
        print(f"  Note: {note}")
    lab.notes.clear()


def _unexpected(lab):
    """Exit status: what did not come out as expected, or 0."""
    failures = [str(outcome) for outcome in lab.outcomes if not outcome.is_expected()]
    return "unexpected: " + "; ".join(failures) if failures else 0


if __name__ == "__main__":
    sys.exit(main())
