// Not a number: refused at the door.
#include <limits>

#include "harness/base/text.h"
#include "harness/stability/case_parts.h"
#include "harness/stability/hard_case.h"

namespace harness {

using namespace case_parts;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

void add_impossible_numbers(std::vector<HardCase>& cases, const HardCaseValues& /*values*/) {
  const auto add = [&](const std::string& name, const std::function<void(Mesh&)>& corrupt) {
    cases.push_back({"not a number",
                     "door/" + name,
                     name + " of a vertex or edge",
                     [corrupt] {
                       Mesh mesh = chain(4);
                       corrupt(mesh);
                       return trial_of(std::move(mesh), 0.01, 3);
                     },
                     {{everyone, refuses, "at the door, naming it"}}});
  };
  for (const double value : {nan, infinity}) {
    add("position " + number_text(value), [value](Mesh& m) { m.start.x(1, 2) = value; });
    add("velocity " + number_text(value), [value](Mesh& m) { m.start.v(0, 3) = value; });
  }
  for (const double value : {nan, infinity, 0.0, -1.0}) {
    add("mass " + number_text(value), [value](Mesh& m) { m.parts.mass[2] = value; });
    add("length " + number_text(value), [value](Mesh& m) { m.parts.rest_length[1] = value; });
  }
}

}  // namespace harness
