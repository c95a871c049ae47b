"""Values of other programs' metrics, which tests/diff/independent.rs has written down.

    pip install numpy scikit-image flip-evaluator
    python tests/diff/reference.py

The images come from an integer hash, so that both sides make the same bits.
"""

import flip_evaluator
import numpy as np
from skimage.metrics import peak_signal_noise_ratio, structural_similarity

WIDTH, HEIGHT = 40, 32
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def uniform(n):
    """24 bits of a multiplicative hash, in [0, 1)."""
    x = (n.astype(np.uint64) * np.uint64(2654435761) + np.uint64(12345)) & np.uint64(0xFFFFFFFF)
    x = ((x ^ (x >> np.uint64(15))) * np.uint64(2246822519)) & np.uint64(0xFFFFFFFF)
    return (x >> np.uint64(8)).astype(np.float64) / 2.0**24


def images():
    """Bars and a bright square under noise, and the same with other noise and a shifted bar."""
    y, x, c = np.meshgrid(np.arange(HEIGHT), np.arange(WIDTH), np.arange(3), indexing="ij")
    n = (y * WIDTH + x) * 3 + c
    square = ((x >= 20) & (x < 28) & (y >= 8) & (y < 16)) * 6.0
    bars = lambda shift: np.where((x + shift) // 4 % 3 == c, 0.5625, 0.0625)
    reference = bars(0) + square + uniform(n) * 0.125
    image = bars(y // 16) + square * 1.25 + uniform(n + 100000) * 0.25
    return image.astype(np.float32), reference.astype(np.float32)


def encode(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def relative(i, r):
    i, r = i.astype(np.float64), r.astype(np.float64)
    square = (i - r) ** 2
    mean = (r @ LUMINANCE).mean()
    rel = (square / (r * r + 0.01)).mean(axis=2).ravel()
    print("mse               %.10g" % square.mean())
    print("rel_mse           %.10g" % rel.mean())
    print("rel_mse_trimmed   %.10g" % np.sort(rel)[: round(len(rel) * 0.999)].mean())
    print("relative_rms      %.10g" % np.sqrt((square / (r * r + 0.31 * mean**2)).mean()))
    print("mape              %.10g" % (np.abs(i - r) / (np.abs(r) + 0.01)).mean())
    print("mean_ratio        %.10g" % ((i @ LUMINANCE).mean() / mean))


def shown(i, r):
    mean = (r.astype(np.float64) @ LUMINANCE).mean()
    ev = np.log2(0.18 / mean)
    print("exposure_ev       %.10g" % ev)
    i, r = [np.clip(v * np.float32(2.0**ev), 0, 1) for v in (i, r)]
    ei, er = encode(i.astype(np.float64)), encode(r.astype(np.float64))
    print("psnr_db           %.10g" % peak_signal_noise_ratio(er, ei, data_range=1))
    luma = [encode(v.astype(np.float64) @ LUMINANCE) for v in (i, r)]
    print("ssim              %.10g" % structural_similarity(
        luma[0], luma[1], data_range=1, gaussian_weights=True, sigma=1.5, use_sample_covariance=False))
    flip_map, mean, _ = flip_evaluator.evaluate(
        er.astype(np.float32), ei.astype(np.float32), "LDR", applyMagma=False)
    pooled("flip", flip_map)


def light(i, r):
    flip_map, mean, found = flip_evaluator.evaluate(r, i, "HDR", applyMagma=False)
    print("start_ev, stop_ev, count  %.10g %.10g %d" % (
        found["startExposure"], found["stopExposure"], found["numExposures"]))
    pooled("flip_hdr", flip_map)


def pooled(name, flip_map):
    values = np.sort(flip_map.ravel().astype(np.float64))
    sums = np.cumsum(values)
    quartiles = [values[np.searchsorted(sums, sums[-1] * q)] for q in (0.25, 0.5, 0.75)]
    print("%s mean  %.8g  quartiles %.6g %.6g %.6g  max %.6g" % (
        name, values.mean(), *quartiles, values[-1]))


if __name__ == "__main__":
    image, reference = images()
    print("first and last    %.9g %.9g" % (image[0, 0, 0], reference[-1, -1, 2]))
    relative(image, reference)
    shown(image, reference)
    light(image, reference)
