"""How the six entries xx, yy, zz, xy, yz, zx of a symmetric tensor are numbered."""

import numpy as np

#: Where entry (i, j) of a symmetric tensor stands among its six; and the other way round.
SIX = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
FIRST = np.array([0, 1, 2, 0, 1, 2])
SECOND = np.array([0, 1, 2, 1, 2, 0])
