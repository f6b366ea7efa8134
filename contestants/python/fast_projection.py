"""Fast projection (Goldenthal et al. 2007, Algorithm 1) with scipy's sparse matrices and LU factorization.

A constraint is C_k = |x_b - x_a|^2 / l_k - l_k, row k of its gradient J holds 2 (x_b - x_a) / l_k at b and the negative at a. A
projection solves (J W J^T) mu = C and moves x by -W J^T mu. bench has the same method with a factorization of its own, and
fewer digits where these suffice; with `linear_solver` multifrontal both agree to rounding."""

import numpy as np
from scipy.sparse import csr_matrix, diags
from scipy.sparse.linalg import splu


class FastProjection:
    name = "scipy_fast_projection"
    summary = "fast projection with scipy.sparse"
    label = "fast projection (scipy)"
    citation = "Goldenthal et al. 2007"
    takes = {"momentum"}  # conserves it
    direction = "current"
    settings = {"max_iterations": (200, 1, 10**9, "projections a step before it is refused")}

    def __init__(self, scene, max_iterations):
        self.max_iterations = max_iterations
        self.rest_length, (self.a, self.b) = scene.rest_length, scene.edges.T
        self.low, self.high = max(1 - scene.strain_limit, 0)**2, (1 + scene.strain_limit)**2
        self.W = diags(np.repeat(scene.inverse_mass, 3))
        # Columns of J in each row: x, y, z of a, then of b. `data` of J is filled in anew at each iterate.
        ends = np.hstack([3 * scene.edges[:, [0]] + range(3), 3 * scene.edges[:, [1]] + range(3)])
        m = len(self.rest_length)
        self.J = csr_matrix((np.zeros(6 * m), ends.ravel(), np.arange(0, 6 * m + 1, 6)), shape=(m, 3 * scene.vertices))

    def filter(self, step):
        x = step.x
        for j in range(self.max_iterations + 1):
            d = x[self.b] - x[self.a]
            squared = (d * d).sum(axis=1) / self.rest_length**2
            if np.all((squared >= self.low) & (squared <= self.high)):
                return None
            if j == self.max_iterations:
                return "iteration limit"
            u = 2 * d / self.rest_length[:, None]
            self.J.data[:] = np.hstack([-u, u]).ravel()
            WJt = self.W @ self.J.T
            mu = splu((self.J @ WJt).tocsc()).solve(self.rest_length * (squared - 1))
            x -= (WJt @ mu).reshape(x.shape)
            step.iterations += 1
            step.assemblies += 1
            step.factorizations += 1
            step.back_solves += 1
