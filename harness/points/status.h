// How a run ended.
#pragma once

#include <array>
#include <cstddef>

namespace harness {

enum class PointStatus {
  ok,
  strain_missed,
  energy_gained,
  motion_lost,
  not_converged,
  diverged,
  timeout,
  out_of_memory,
  crashed,
  unsupported,
  skipped,
};

struct PointStatusInfo {
  PointStatus status;
  const char* name;
  const char* letter;  // of a failure, in figures
  const char* meaning;
};

// In the order of PointStatus. Files, schemas, figures and `bench list statuses` follow it.
inline constexpr std::array point_statuses{
    PointStatusInfo{PointStatus::ok, "ok", "", "ran to the end within its strain limit"},
    PointStatusInfo{PointStatus::strain_missed, "strain_missed", "S",
                    "an edge was strained more than permitted"},
    PointStatusInfo{PointStatus::energy_gained, "energy_gained", "E",
                    "energy rose by more than the scene's bound"},
    PointStatusInfo{
        PointStatus::motion_lost, "motion_lost", "M",
        "moved less than half as far as the reference, or kinetic energy is not the ensemble's"},
    PointStatusInfo{PointStatus::not_converged, "not_converged", "N",
                    "the solver refused a step: out of iterations, or no progress"},
    PointStatusInfo{PointStatus::diverged, "diverged", "D",
                    "a position was not finite, or an edge was strained more than tenfold"},
    PointStatusInfo{PointStatus::timeout, "timeout", "T",
                    "took longer than a point may, or could no longer be the best"},
    PointStatusInfo{PointStatus::out_of_memory, "out_of_memory", "O",
                    "needed more memory than it was given"},
    PointStatusInfo{PointStatus::crashed, "crashed", "C", "ended its process"},
    PointStatusInfo{PointStatus::unsupported, "unsupported", "U",
                    "the solver does not support this problem"},
    PointStatusInfo{
        PointStatus::skipped, "skipped", "K",
        "not run: every step timed out at the neighbouring, easier point; or its calibration "
        "timed out"}};
static_assert([] {
  for (std::size_t i = 0; i < point_statuses.size(); ++i)
    if (static_cast<std::size_t>(point_statuses[i].status) != i) return false;
  return point_statuses.back().status == PointStatus::skipped;
}());

constexpr const char* to_string(PointStatus status) {
  return point_statuses[static_cast<std::size_t>(status)].name;
}

}  // namespace harness
