// Chains that hang, whose motion or rest is known: small oscillations, the catenary, and a chain
// that whirls about the vertical.
#pragma once

namespace harness {

// omega_k, rad/s, k from 1 on, of the small oscillations of N equal masses on links of length l (m)
// that hang from a point: omega_k^2 = (g / l) x_k, x_k the k-th zero of the Laguerre polynomial L_N
// (Bernoulli 1733 for the limit of many). g: m/s^2. 1 <= mode <= masses.
double hanging_frequency(int masses, double link, double gravity, int mode);

}  // namespace harness
