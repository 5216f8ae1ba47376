"""Checks that a picture shows something: its size, that it is mostly white, and that it has many colours.

    check_picture.py PICTURE.png ...
"""

import sys

import numpy as np
from matplotlib.image import imread

for path in sys.argv[1:]:
    pixels = (imread(path)[:, :, :3] * 255).round().astype(np.uint32)
    height, width = pixels.shape[:2]
    assert width >= 1000 and height >= 300, f"{path}: {width} x {height}"
    codes = pixels[:, :, 0] << 16 | pixels[:, :, 1] << 8 | pixels[:, :, 2]
    colours, counts = np.unique(codes, return_counts=True)
    assert len(colours) > 60, f"{path}: only {len(colours)} colours"
    white = counts[colours == 0xFFFFFF].sum() / codes.size
    assert 0.2 < white < 0.98, f"{path}: {white:.0%} white"
    for side, edge in (("left", codes[:, 0]), ("right", codes[:, -1]), ("top", codes[0]), ("bottom", codes[-1])):
        assert (edge == 0xFFFFFF).all(), f"{path}: something is cut off at the {side}"
