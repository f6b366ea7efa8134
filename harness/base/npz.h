// Arrays of numbers in NumPy's files.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace harness {

struct NumberArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;  // the last index varies fastest
};
using NumberArrays = std::map<std::string, NumberArray>;

// The arrays of float and int numbers of an .npz file. Throws UsageError, naming the file, if it is
// none or has no such array.
NumberArrays read_npz(const std::string& path);

// An .npz file with these arrays, as float64.
std::string npz_bytes(const NumberArrays& arrays);

}  // namespace harness
