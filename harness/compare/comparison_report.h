// A comparison as people and CI servers read it.
#pragma once

#include <ostream>
#include <string>

#include "harness/compare/comparison.h"

namespace harness {

// A table of the points that are not SAME, the notes, and how many there are of each kind of
// change.
void print_comparison(std::ostream& out, const Comparison& comparison);

// JUnit XML: one test case a point; regressions and failures are its failures. name: the suite's.
std::string junit_xml(const Comparison& comparison, const std::string& name);

// The same table for a pull request or a job summary. title: its heading.
std::string markdown_table(const Comparison& comparison, const std::string& title);

}  // namespace harness
