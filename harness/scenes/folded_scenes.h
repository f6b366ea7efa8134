// Chains folded into a U, one arm of which moves along the other: faster and faster, because what
// moves becomes less and its energy stays.
//
// With s the way of the free end over the chain's length L, v its speed and mu the mass per length,
// the moving arm is (1 - s) L / 2 long. Without gravity, v = v_0 / sqrt(1 - s); falling from rest,
// v^2 = g L s (2 - s) / (1 - s) (Calkin and March 1989; Schagerl et al. 1997 measured it). A chain
// of links follows this to O(link / L), as long as several links move.
#pragma once

namespace harness {

// s, after which the free end has fallen this part of the length.
double folded_fall_time(double part, double length, double gravity);

}  // namespace harness
