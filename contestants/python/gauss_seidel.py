"""Strain limiting by Gauss-Seidel in numpy: edges of one color share no vertex and are corrected at once, color after color."""

import numpy as np


def colors_of(edges):
    """The first color of each edge that no edge before it has at a common vertex."""
    taken, colors = {}, []
    for a, b in edges.tolist():
        here, there = taken.setdefault(a, set()), taken.setdefault(b, set())
        color = next(c for c in range(len(edges)) if c not in here and c not in there)
        here.add(color)
        there.add(color)
        colors.append(color)
    return np.array(colors, dtype=int)


class GaussSeidel:
    name = "numpy_gauss_seidel"
    summary = "strain limiting in numpy, all edges of a color at once"
    label = "Gauss-Seidel (numpy)"
    takes = {"collider"}
    direction = "local"
    settings = {"max_iterations": (10_000, 1, 10**9, "sweeps a step before it is refused")}

    def __init__(self, scene, max_iterations):
        self.max_iterations, self.limit = max_iterations, scene.strain_limit
        self.edges, self.rest_length = scene.edges, scene.rest_length
        colors = colors_of(scene.edges)
        self.groups = [(scene.edges[k], scene.rest_length[k], scene.inverse_mass[scene.edges[k]])
                       for k in (np.flatnonzero(colors == color) for color in np.unique(colors))]

    def filter(self, step):
        x = step.x
        for step.iterations in range(self.max_iterations):
            step.settle()  # vertices that went into the body are put back
            a, b = self.edges.T
            if np.all(np.abs(np.linalg.norm(x[b] - x[a], axis=1) / self.rest_length - 1) <= self.limit):
                return None
            for (a, b), rest, w in ((edges.T, rest, w) for edges, rest, w in self.groups):
                d = x[b] - x[a]
                ratio = np.maximum(np.linalg.norm(d, axis=1), 1e-300) / rest  # without length, no direction: d is 0
                share = np.where(np.abs(ratio - 1) > self.limit, (1 - 1 / ratio) / w.sum(axis=1), 0)
                x[a] += (w[:, 0] * share)[:, None] * d
                x[b] -= (w[:, 1] * share)[:, None] * d
            step.edge_projections += len(self.edges)
        return "sweep limit"
