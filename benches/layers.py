"""A layer of an EXR that terrarium has written, as an 8-bit PNG: one part, ZIP, 32-bit float."""

import array
import struct
import sys
import zlib


def text_until_zero(data, at):
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1


def read(path, wanted):
    """Width, height and the wanted channels as arrays of floats, row by row."""
    with open(path, "rb") as file:
        data = file.read()
    at, header = 8, {}
    while data[at]:
        name, at = text_until_zero(data, at)
        _, at = text_until_zero(data, at)
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    channels, place = [], 0
    while header["channels"][place]:
        name, place = text_until_zero(header["channels"], place)
        assert struct.unpack_from("<i", header["channels"], place)[0] == 2, "a channel is not of 32-bit floats"
        place += 16
        channels.append(name)
    assert header["compression"] in (b"\2", b"\3"), "not compressed by ZIP"
    rows = 1 if header["compression"] == b"\2" else 16
    left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    blocks = struct.unpack_from(f"<{-(-height // rows)}Q", data, at)
    result = {name: array.array("f", bytes(4 * width * height)) for name in wanted}
    for offset in blocks:
        first, size = struct.unpack_from("<ii", data, offset)
        lines = min(rows, bottom - first + 1)
        plain = unpack(data[offset + 8:offset + 8 + size], 4 * width * len(channels) * lines)
        for line in range(lines):
            for k, name in enumerate(channels):
                if name in result:
                    begin = 4 * width * (line * len(channels) + k)
                    values = array.array("f", plain[begin:begin + 4 * width])
                    row = first - top + line
                    result[name][row * width:(row + 1) * width] = values
    if sys.byteorder == "big":
        for values in result.values():
            values.byteswap()
    return width, height, [result[name] for name in wanted]


def unpack(packed, size):
    """Undoes EXR's ZIP: bytes are differences, and the even ones come first."""
    if len(packed) == size:
        return packed
    data = bytearray(zlib.decompress(packed))
    value = data[0]
    for i in range(1, len(data)):
        value = (value + data[i] - 128) & 255
        data[i] = value
    half = (len(data) + 1) // 2
    result = bytearray(len(data))
    result[0::2], result[1::2] = data[:half], data[half:]
    return bytes(result)


def png(path, width, height, bytes_):
    """8-bit RGB."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + bytes_[3 * width * y:3 * width * (y + 1)] for y in range(height))
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
                   + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def srgb(value):
    value = min(max(value, 0.0), 1.0)
    return round(255 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055))


def write_layer(exr, layer, out):
    """`edges` as shares in grey; `photons` in their own colours, the brightest a full white, over the picture."""
    if layer == "edges":
        width, height, (values,) = read(exr, ["edges.Y"])
        shown = bytearray(3 * width * height)
        for i, value in enumerate(values):
            shown[3 * i:3 * i + 3] = bytes([round(255 * min(max(value, 0.0), 1.0))]) * 3
    else:
        width, height, planes = read(exr, ["R", "G", "B"] + [f"{layer}.{c}" for c in "RGB"])
        shown = bytearray(3 * width * height)
        ground, dots = planes[:3], planes[3:]
        lit = sorted(value for value in map(max, zip(*dots)) if value > 0)
        full = lit[len(lit) // 2] if lit else 1.0
        for i in range(width * height):
            dot = [plane[i] / full for plane in dots]
            seen = dot if max(dot) > 0 else [0.35 * plane[i] for plane in ground]
            shown[3 * i:3 * i + 3] = bytes(map(srgb, seen))
    png(out, width, height, bytes(shown))
