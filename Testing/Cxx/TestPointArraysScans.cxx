// SPDX-License-Identifier: BSD-3-Clause
/**
 * Colours with noise on the Stanford bunny: nearer to the truth than those of the nearest point.
 */
#include "IPIATestColours.h"
#include "IPIATestScans.h"
#include "IPIATestUtilities.h"

int TestPointArraysScans(int argc, char* argv[])
{
  ipiatest::Checks checks;
  auto bunny = ipiatest::ReadScan(ipiatest::ScanFolder(argc, argv), "bunny00");
  if (checks.That(bunny->GetNumberOfPoints() > 0, "the bunny can be read"))
  {
    const auto errors = ipiatest::NoisyColours(bunny);
    checks.AtMost(errors.OfSurface, 0.4 * errors.OfNearest, "error in that of the nearest point");
  }
  return checks.Result();
}
