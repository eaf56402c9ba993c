"""Pictures and animations as files."""
import os

import numpy as np
from paraview import simple
from PIL import Image


def drawn(path, view, size):
    """The view as an image. Drawn twice as large: edges come out half a pixel wide."""
    simple.SaveScreenshot(path, view, ImageResolution=[2 * n for n in size])
    with Image.open(path) as picture:
        colours = np.asarray(picture.convert("RGB"), dtype=np.float32)
    width, height = size
    return Image.fromarray(colours.reshape(height, 2, width, 2, 3).mean(axis=(1, 3)).astype(np.uint8))


def save_picture(path, view, size, largest):
    """A PNG; where it may have but so many bytes, of fewer colours, then of fewer pixels."""
    for scale, number in ((1.0, None), (1.0, 256), (1.0, 64), (1.0, 32), (0.85, 64), (0.7, 64), (0.5, 64)):
        pixels = [int(scale * n) for n in size]
        picture = drawn(path, view, pixels)
        if number is not None:
            picture = picture.quantize(number, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        picture.save(path, optimize=True)
        if largest is None or os.path.getsize(path) <= largest:
            break
    return pixels


def save_animation(path, frames, seconds):
    """An endless GIF; its last frame stands for a second. One palette, that of all frames, so that colours stand
    still."""
    step = max(1, len(frames) // 8)
    some = np.concatenate([np.asarray(frame) for frame in frames[::step]])
    palette = Image.fromarray(some).quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    indexed = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    each = int(1000 * seconds / len(frames))
    indexed[0].save(path, save_all=True, append_images=indexed[1:], loop=0, optimize=True,
                    duration=[each] * (len(frames) - 1) + [1000])
