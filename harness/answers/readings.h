// What answers read off runs.
#pragma once

#include "harness/answers/answer.h"

namespace harness {

// RMS distance from the scene's exact motion at the end of the run, over the scene's size.
std::unique_ptr<Reading> distance_at_the_end(const AnswerScene& at);

// The angle by which a body that stays centered on the origin turns in the last step, over the
// step's duration and the initial rate.
std::unique_ptr<Reading> turning_rate_kept(const AnswerScene& at);

// A swinging chain's frequency, rad/s, and the part of its amplitude that is left after a period,
// both of the free end.
std::unique_ptr<Reading> swing_frequency(const AnswerScene& at);
std::unique_ptr<Reading> swing_kept(const AnswerScene& at);

// The largest deviation of a link's tension from the catenary's, over the largest tension there.
std::unique_ptr<Reading> catenary_tensions(const AnswerScene& at);

// The time in which the free end of a folded chain moves by this part of the length, and its speed
// at that time over the initial one. Closer to the end so few links still move that the chain no
// longer resembles a continuum.
constexpr double folded_part = 0.9;
std::unique_ptr<Reading> folded_time(const AnswerScene& at);
std::unique_ptr<Reading> folded_speed(const AnswerScene& at);

// RMS deviation of the angle between warp and weft from that of a net on a sphere, in degrees, over
// the cells whose four corners lie on the ball at the end.
std::unique_ptr<Reading> net_angle_deviation(const AnswerScene& at);

// Cusick's drape coefficient (BS 5058, ISO 9073-9), %: the part of the ring between table and rim
// that the shadow of the draped disc covers.
std::unique_ptr<Reading> drape_coefficient(const AnswerScene& at);

}  // namespace harness
