// What is known of chains: small oscillations of one that hangs, and the fall of a folded one.
#pragma once

namespace harness {

// omega_k, rad/s, k from 1 on, of the small oscillations of N equal masses on links of length l (m)
// that hang from a point: omega_k^2 = (g / l) x_k, x_k the k-th zero of the Laguerre polynomial L_N
// (Bernoulli 1733 for the limit of many). g: m/s^2. 1 <= mode <= masses.
double hanging_frequency(int masses, double link, double gravity, int mode);

// s, after which the free end of a chain that is folded into a U has fallen this part of the
// length.
//
// With s the way of the free end over the chain's length L, v its speed and mu the mass per length,
// the moving arm is (1 - s) L / 2 long. Without gravity, v = v_0 / sqrt(1 - s); falling from rest,
// v^2 = g L s (2 - s) / (1 - s) (Calkin and March 1989; Schagerl et al. 1997 measured it). A chain
// of links follows this to O(link / L), as long as several links move.
double folded_fall_time(double part, double length, double gravity);

}  // namespace harness
