#include "harness/run/quiet_samples.h"

#include "harness/run/noise_probe.h"

namespace harness {

namespace {
constexpr int first_looks = 10;
}

QuietProbe::QuietProbe() : work_(fixed_work) {}

double QuietProbe::look() {
  if (least_ == std::numeric_limits<double>::infinity()) {
    for (int i = 0; i < first_looks; ++i) least_ = std::min(least_, work_());
  }
  const double seconds = work_();
  least_ = std::min(least_, seconds);
  return seconds;
}

void QuietProbe::renew(double least) { least_ = std::min(std::exchange(renewed_, least), least); }

QuietProbe& quiet_probe() {
  static QuietProbe probe;
  return probe;
}

}  // namespace harness
