# SPDX-License-Identifier: BSD-3-Clause
"""The parts of reproduce_rational_2024.py."""
