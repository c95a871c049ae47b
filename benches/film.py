#!/usr/bin/env python3
"""A GIF or WebP of numbered frames: film.py FOLDER OUTPUT FRAMES_A_SECOND."""

import os
import sys
from pathlib import Path

from PIL import Image


def main(folder, output, rate):
    names = sorted(Path(folder).glob("*.png"))
    if not names:
        sys.exit(f"{folder} holds no frames")
    frames = [Image.open(name).convert("RGB") for name in names]
    if output.endswith(".gif"):
        # one palette for all frames, of the first, the middle and the last: colours that stay do not flicker
        width, height = frames[0].size
        sheet = Image.new("RGB", (width, 3 * height))
        for row, frame in enumerate((frames[0], frames[len(frames) // 2], frames[-1])):
            sheet.paste(frame, (0, row * height))
        palette = sheet.quantize(256)
        frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    temporary = f"{output}.tmp-{os.getpid()}"
    options = {"format": Path(output).suffix[1:], "save_all": True, "append_images": frames[1:]}
    frames[0].save(temporary, duration=round(1000 / float(rate)), loop=0, **options)
    os.replace(temporary, output)
    print(f"wrote {output}")


main(*sys.argv[1:])
