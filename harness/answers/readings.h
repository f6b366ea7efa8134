// What answers read off runs.
#pragma once

#include "harness/answers/answer.h"

namespace harness {

// RMS distance from the scene's exact motion at the end of the run, over the scene's size.
std::unique_ptr<Reading> distance_at_the_end(const AnswerScene& at);

// Of a body that is centred on the origin and stays so: the angle of the last step over its
// duration, over the rate at the start.
std::unique_ptr<Reading> turning_rate_kept(const AnswerScene& at);

// Of the free end of a chain that swings: its frequency, rad/s, and the part of its amplitude that
// it keeps in a period.
std::unique_ptr<Reading> swing_frequency(const AnswerScene& at);
std::unique_ptr<Reading> swing_kept(const AnswerScene& at);

// The largest deviation of a link's tension from the catenary's, over the largest tension there.
std::unique_ptr<Reading> catenary_tensions(const AnswerScene& at);

// Of the free end of a folded chain: the time in which it moves this part of the length, and its
// speed then over the start's. Where the links are few that still move, a chain of links is no
// continuum any more.
constexpr double folded_part = 0.9;
std::unique_ptr<Reading> folded_time(const AnswerScene& at);
std::unique_ptr<Reading> folded_speed(const AnswerScene& at);

// RMS deviation of the angle between warp and weft from the net's on a sphere, in degrees, over the
// cells whose four corners lie on the ball at the end.
std::unique_ptr<Reading> net_angle_deviation(const AnswerScene& at);

// Cusick's drape coefficient (BS 5058, ISO 9073-9), %: the part of the ring between table and rim
// that the shadow of the draped disc covers.
std::unique_ptr<Reading> drape_coefficient(const AnswerScene& at);

}  // namespace harness
