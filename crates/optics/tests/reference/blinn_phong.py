"""J. F. Blinn, SIGGRAPH 1977, with F. Giesen's normalisation (2009)."""

import numpy as np

import phong
from common import half

SETS = phong.SETS


def norm(n):
    return (n + 2) * (n + 4) / (8 * np.pi * (2 ** (-n / 2) + n))


f = phong.highlight(lambda o, i, n: half(o, i)[:, 2] ** n, norm)
