# SPDX-License-Identifier: BSD-3-Clause
"""The models, fits and pictures of reproduce_ipia_2019.py, one concept per file."""
