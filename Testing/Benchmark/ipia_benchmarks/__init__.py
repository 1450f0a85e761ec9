# SPDX-License-Identifier: BSD-3-Clause
"""Runs the programs of the benchmarks and tells what they cost; see Documentation/Benchmarks.md."""
