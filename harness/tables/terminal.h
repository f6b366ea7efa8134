// What a terminal shows of a sweep's result: the fastest methods, the answer in words, how time
// grows.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <ostream>

namespace harness {

// At most `columns` wide. For each scene and size a line for each answer of the plane strain x
// error, levels of error with the same answer in one; then its findings (analysis/findings.h), and
// of resolution sweeps the growth of a step's time. all: every contestant too, fastest first, and
// how the runs that failed ended.
// document: of schema inextensible-bench/1.
void print_sweep(std::ostream& out, const nlohmann::json& document, bool all = false,
                 std::size_t columns = 120);

}  // namespace harness
