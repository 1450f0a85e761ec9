// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file
 * How much the points of overlapping scans count.
 */
#ifndef IPIAScanFeathering_h
#define IPIAScanFeathering_h

#include <vector>

namespace ipia
{
class PointCloud;

/**
 * A factor in [0.05, 1] for the weight of each point of a cloud whose blocks are scans, as
 * vtkIPIAImplicitFitter's FeatherScans tells; nothing if there are fewer than two scans. Does not
 * depend on the number of threads.
 */
std::vector<double> featherFactors(const PointCloud& cloud);
}

#endif
