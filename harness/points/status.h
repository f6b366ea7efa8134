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
                    "ran to the end, strained beyond its limit"},
    PointStatusInfo{PointStatus::energy_gained, "energy_gained", "E",
                    "ran to the end, and made energy out of nothing"},
    PointStatusInfo{
        PointStatus::motion_lost, "motion_lost", "M",
        "ran to the end, and hardly moved, or hung or shook, where the reference does not"},
    PointStatusInfo{PointStatus::not_converged, "not_converged", "N",
                    "the solver gave up on a step and said so"},
    PointStatusInfo{PointStatus::diverged, "diverged", "D",
                    "positions not finite, or strains out of all proportion"},
    PointStatusInfo{PointStatus::timeout, "timeout", "T", "took longer than it was given"},
    PointStatusInfo{PointStatus::out_of_memory, "out_of_memory", "O", "asked for too much memory"},
    PointStatusInfo{PointStatus::crashed, "crashed", "C", "ended its process"},
    PointStatusInfo{PointStatus::unsupported, "unsupported", "U",
                    "the solver does not take this problem"},
    PointStatusInfo{PointStatus::skipped, "skipped", "K",
                    "was not run, or timed out while calibrating"}};
static_assert([] {
  for (std::size_t i = 0; i < point_statuses.size(); ++i)
    if (static_cast<std::size_t>(point_statuses[i].status) != i) return false;
  return point_statuses.back().status == PointStatus::skipped;
}());

constexpr const char* to_string(PointStatus status) {
  return point_statuses[static_cast<std::size_t>(status)].name;
}

}  // namespace harness
