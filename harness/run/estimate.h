// How long a sweep will take, from steps that are timed.
#pragma once

#include <vector>

#include "harness/points/suite.h"
#include "harness/run/plan.h"

namespace harness {

struct Estimate {
  double seconds = 0;  // of the sweep
  int timed = 0;       // (scene, size, contestant)s, a few steps of each
};

// Times a few steps of each contestant at each size, at the middle limit and a middle step, and
// takes every search for what most searches are: a handful of runs, and repetitions of one. Within
// a factor of three, mostly. Takes a second or so for each ten contestants and sizes.
Estimate estimate(const Suite& suite, const std::vector<Search>& searches);

}  // namespace harness
