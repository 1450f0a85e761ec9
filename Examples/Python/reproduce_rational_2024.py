#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""
Reproduces the examples and tables of

  S. Huang: Implicit uniform rational spline reconstruction method with regularization term. 2024

with vtkIPIAImplicitFitter: Examples 1 to 11 as pictures of f, Tables 1 to 4 on the console beside
the paper's figures. Rendering needs a display; without one run it under xvfb-run -a.

  PYTHONPATH=<build>/lib/python3/dist-packages python3 reproduce_rational_2024.py
"""

import argparse
from pathlib import Path
import sys
import time

from rational_2024.examples import NOISE, TABLES
from rational_2024.fitting import MARGIN, OFFSET_DISTANCE, OFFSET_VALUE, TOLERANCE
from rational_2024.laboratory import Laboratory
from rational_2024.pictures import FIGURES
from rational_2024.sheets import sheet_lines
from rational_2024.steps import step_lines

DEFAULT_OUTPUT = Path("ipia-output/paper-2024")
COMPARISONS = {"tau": step_lines, "sheets": sheet_lines}
QUICK = ("example1", "fig15", *TABLES)

SETTINGS = f"""\
Settings: offsets of {OFFSET_DISTANCE} on both sides with values of {OFFSET_VALUE}, as in the paper. It gives no
  domain: here the box of the points and {MARGIN} of its longest side. Examples 1, 9 and 10 have its
  formulas; the other curves are stand-ins of this script with the paper's numbers of points, 8 long,
  so that their figures can only be compared with each other. Tables 2 to 4 stop at |E_new - E_old| <
  {TOLERANCE:g}, Table 1 after 200 iterations. Tables 1 to 3 take the printed step (AsPrinted); in Table 4
  lambda is beyond its limit of 1/16: Energy. Noise: {NOISE} on each coordinate.
  Extra loops are those of f = 0 beside one, of the spline alone, without the filter's far field."""


def main():
    options = _parse_arguments()
    options.output.mkdir(parents=True, exist_ok=True)
    lab = Laboratory()
    print(SETTINGS)
    start = time.perf_counter()
    for name in options.only or (QUICK if options.quick else (*TABLES, *COMPARISONS, *FIGURES)):
        print(f"\n{name}")
        if name in TABLES:
            print("\n".join(lab.table_lines(TABLES[name])))
        elif name in COMPARISONS:
            print("\n".join(COMPARISONS[name](lab)))
        else:
            path = options.output / f"{name}.png"
            path.unlink(missing_ok=True)
            FIGURES[name](lab).write(path)
            if not path.is_file():
                return f"reproduce_rational_2024.py: {path} could not be written"
            print(path)
    failures = lab.failures() if options.quick else []
    print(f"\n{time.perf_counter() - start:.0f} s in all")
    return "unexpected: " + "; ".join(failures) if failures else 0


def _parse_arguments():
    parser = argparse.ArgumentParser(description="Reproduces the paper on rational splines of 2024.")
    parser.add_argument("--only", nargs="+", choices=[*TABLES, *COMPARISONS, *FIGURES], metavar="NAME",
                        help="what to make: " + ", ".join([*TABLES, *COMPARISONS, *FIGURES]))
    parser.add_argument("--output", type=Path, default=DEFAULT_OUTPUT,
                        help="folder of the pictures (default: %(default)s)")
    parser.add_argument("--quick", action="store_true",
                        help="two pictures and all tables; fails unless what the paper claims of "
                             "them is seen")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
