"""What the reference formulas share. Everything is float64 and vectorised: directions are arrays (N, 3) whose z is the
normal, values arrays (N, 3) of red, green and blue. Written from the papers, apart from the Rust code."""

import numpy as np


def parse(line):
    """A parameter set as tests write it: `name=value` words, colours as r,g,b."""
    out = {"outside": 1.0}
    for word in line.split():
        name, text = word.split("=")
        try:
            numbers = [float(x) for x in text.split(",")]
            out[name] = numbers[0] if len(numbers) == 1 else np.array(numbers)
        except ValueError:
            out[name] = {"true": True, "false": False}.get(text, text)
    return out


class Set(dict):
    """Parameters with the model's defaults behind them."""

    def color(self, name, default):
        return np.broadcast_to(np.asarray(self.get(name, default), float), (3,))


def dot(a, b):
    return np.sum(a * b, axis=-1)


def unit(v):
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def half(o, i):
    return unit(o + i)


def column(x):
    return np.asarray(x)[:, None]


def two_sided(f):
    """Turn a model of the upper side into an opaque one that looks the same from below."""

    def turned(o, i, p):
        out = np.zeros((len(o), 3))
        same = o[:, 2] * i[:, 2] > 0
        flip = np.where(o[:, 2:] < 0, np.array([1.0, 1.0, -1.0]), 1.0)
        with np.errstate(all="ignore"):
            out[same] = f((o * flip)[same], (i * flip)[same], p)
        return out

    return turned


def fresnel_dielectric(cos, eta_o, eta_i):
    """Unpolarised; 1 under total reflection. By Stokes' amplitudes through complex cosines."""
    cos_t = np.sqrt(1 - (eta_o / eta_i) ** 2 * (1 - cos**2) + 0j)
    s = (eta_o * cos - eta_i * cos_t) / (eta_o * cos + eta_i * cos_t)
    p = (eta_i * cos - eta_o * cos_t) / (eta_i * cos + eta_o * cos_t)
    return 0.5 * (np.abs(s) ** 2 + np.abs(p) ** 2)


def fresnel_conductor(cos, n, k):
    """Unpolarised, from vacuum, by complex amplitudes."""
    eta = n + 1j * k
    cos_t = np.sqrt(1 - (1 - cos**2) / eta**2)
    s = (cos - eta * cos_t) / (cos + eta * cos_t)
    p = (eta * cos - cos_t) / (eta * cos + cos_t)
    return 0.5 * (np.abs(s) ** 2 + np.abs(p) ** 2)


def schlick(r0, cos):
    return r0 + (1 - r0) * (1 - cos) ** 5
