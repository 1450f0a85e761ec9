# SPDX-License-Identifier: BSD-3-Clause
"""Parts of reproduce_fairing_pia_2022.py."""
