"""Linear images read with nothing but the standard library, and how far they lie apart."""

import array
import struct
import zlib


def read(path):
    """Red, green and blue of every pixel, row by row, as one array of floats."""
    with open(path, "rb") as file:
        data = file.read()
    return ppm(data) if data[:2] == b"P6" else exr(data)


def ppm(data):
    """A binary PPM of 16 bits; the full scale is 1."""
    fields, at = [], 2
    while len(fields) < 3:
        end = at
        while data[end:end + 1].isspace():
            end += 1
        if data[end:end + 1] == b"#":
            at = data.index(b"\n", end)
            continue
        at = end
        while not data[at:at + 1].isspace():
            at += 1
        fields.append(int(data[end:at]))
    values = array.array("H", data[at + 1:])
    values.byteswap()
    return array.array("d", (v / fields[2] for v in values))


def exr(data):
    """A single-part scan-line OpenEXR file, not compressed or ZIP, of half or single precision."""
    if struct.unpack_from("<I", data, 4)[0] & 0x1A00:
        raise ValueError("not a single-part scan-line image")
    channels, compression, window, at = [], 0, None, 8
    while data[at]:
        name, at = text(data, at)
        _, at = text(data, at)
        size = struct.unpack_from("<I", data, at)[0]
        at += 4
        if name == "channels":
            c = at
            while data[c]:
                channel, c = text(data, c)
                channels.append((channel, struct.unpack_from("<I", data, c)[0]))
                c += 16
        elif name == "compression":
            compression = data[at]
        elif name == "dataWindow":
            window = struct.unpack_from("<4i", data, at)
        at += size
    width, height = window[2] - window[0] + 1, window[3] - window[1] + 1
    block = {0: 1, 2: 1, 3: 16}[compression]
    offsets = struct.unpack_from("<%dQ" % -(-height // block), data, at + 1)
    image = array.array("d", bytes(8 * 3 * width * height))
    for offset in offsets:
        y, size = struct.unpack_from("<iI", data, offset)
        raw = data[offset + 8:offset + 8 + size]
        at = 0
        lines = min(block, height - (y - window[1]))
        length = lines * width * sum(2 if kind == 1 else 4 for _, kind in channels)
        if compression and size < length:
            raw = unpredicted(zlib.decompress(raw))
        for line in range(y - window[1], y - window[1] + lines):
            for name, kind in channels:
                bytes_each, code = (2, "e") if kind == 1 else (4, "f" if kind == 2 else "I")
                if name in ("R", "G", "B"):
                    row = struct.unpack_from("<%d%s" % (width, code), raw, at)
                    first = 3 * width * line + "RGB".index(name)
                    image[first:first + 3 * width:3] = array.array("d", row)
                at += bytes_each * width
    return image


def text(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def unpredicted(packed):
    """Undoes ZIP's predictor and puts the two halves of the bytes together again."""
    out, last = bytearray(packed), packed[0]
    for i in range(1, len(out)):
        last = out[i] = (last + out[i] - 128) & 255
    joined = bytearray(len(out))
    half = (len(out) + 1) // 2
    joined[::2], joined[1::2] = out[:half], out[half:]
    return joined


def rel_mse(image, reference, scale=1.0, trimmed=0.001):
    """mean of (I - R)^2 / (R^2 + 0.01), without the share `trimmed` of the worst pixels."""
    errors = []
    for i in range(0, len(reference), 3):
        total = 0.0
        for k in (i, i + 1, i + 2):
            r = reference[k]
            d = image[k] * scale - r
            total += d * d / (r * r + 0.01)
        errors.append(total / 3)
    errors.sort()
    kept = errors[:max(1, round(len(errors) * (1 - trimmed)))]
    return sum(kept) / len(kept)
